#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "polhode/math/detail/functions.hpp"

namespace polhode::ode {

/// The expected error and cost of an adaptive method. Each number is good to about a factor of two and was fitted by
/// benchmarks/planner on random scenes. A plan never chooses a method without a forecast.
struct Forecast {
  /// After n turns the median of the global error is rtol^error_power error_per_turn n (1 + n / secular) +
  /// floor_per_turn n. 0: no forecast.
  double error_per_turn = 0.0;
  double error_power = 1.0;        ///< below 1 if the error falls more slowly than the tolerance
  double secular = 30.0;           ///< turns after which the drift of the energy shows in the phase
  double margin = 1.0;             ///< divides the error that a certificate aims at, where that saves second attempts
  double floor_per_turn = 0.0;     ///< rounding error per turn, at any tolerance
  double steps_per_radian = 0.0;   ///< a radian takes steps_per_radian rtol^-power steps
  double power = 0.0;
  double step_seconds = 0.0;       ///< the time of a step, with a built-in torque
  double order_seconds = 0.0;      ///< adds order_seconds (2 - ln(rtol) / 2)^2, if the order follows the tolerance
  double sample_seconds = 0.0;     ///< the time of a sample
  double calls_per_step = 0.0;     ///< evaluations of the torque in a step
  double stability = 0.0;          ///< the largest stable (rate of decay) x step; 0: no limit (implicit methods)

  bool known() const { return error_per_turn > 0.0; }

  double compute_error(double rtol, double turns) const {
    const double local = error_power == 1.0 ? rtol : math::fast_pow(rtol, error_power);
    return local * error_per_turn * turns * (1 + turns / secular) + floor_per_turn * turns;
  }

  /// The tolerance for a requested error that a certificate is to confirm.
  double find_rtol(double error, double turns) const { return invert(error, margin, turns); }

  /// The tolerance at which half of all scenes have a smaller error.
  double find_median_rtol(double error, double turns) const { return invert(error, 1.0, turns); }

  double compute_steps(double rtol, double turns, double stiffness) const {
    // A decaying rate is followed by some thirty e-foldings, each as long as a radian, until it is negligible.
    return compute_steps_of_radians(rtol, 2 * std::numbers::pi * turns + std::min(stiffness, 30.0), stiffness);
  }

  double compute_steps_of_radians(double rtol, double radians, double stiffness) const {
    const double accurate = 1 + radians * steps_per_radian * math::fast_pow(rtol, -power);
    return stability > 0.0 ? std::max(accurate, stiffness / stability) : accurate;
  }

  /// The time of a step without the user's own torques.
  double compute_step_seconds(double rtol) const {
    const double order = 2 - 0.5 * math::fast_log(rtol);
    return step_seconds + order_seconds * order * order;
  }

  double compute_seconds(double rtol, double turns, double stiffness, double seconds_per_call) const {
    return compute_steps(rtol, turns, stiffness) * (compute_step_seconds(rtol) + calls_per_step * seconds_per_call);
  }

 private:
  double invert(double error, double divisor, double turns) const {
    const double n = std::max(turns, 0.5), local = error / (divisor * error_per_turn * n * (1 + n / secular));
    return error_power == 1.0 ? local : math::fast_pow(local, 1 / error_power);
  }
};

}  // namespace polhode::ode
