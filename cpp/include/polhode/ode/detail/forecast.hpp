#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "polhode/math/detail/functions.hpp"

namespace polhode::ode {

/// The expected error and cost of an adaptive method. Each number is good to about a factor of two and was fitted by
/// benchmarks/planner on random scenes. A plan never chooses a method without a forecast.
struct Forecast {
  /// After n turns the global error is rtol error_per_turn n (1 + n / secular) + floor_per_turn n. 0: no forecast.
  double error_per_turn = 0.0;
  double secular = 30.0;           ///< turns after which the drift of the energy shows in the phase
  double margin = 1.0;             ///< divides the tolerance of a plan, if that is cheaper than a second attempt
  double floor_per_turn = 0.0;     ///< rounding error per turn, at any tolerance
  double steps_per_radian = 0.0;   ///< a radian takes steps_per_radian rtol^-power steps
  double power = 0.0;
  double step_seconds = 0.0;       ///< the time of a step, with a built-in torque
  double order_seconds = 0.0;      ///< adds order_seconds (2 - ln(rtol) / 2)^2, if the order follows the tolerance
  double calls_per_step = 0.0;     ///< evaluations of the torque in a step
  double stability = 0.0;          ///< the largest stable (rate of decay) x step; 0: no limit (implicit methods)

  bool known() const { return error_per_turn > 0.0; }

  double compute_error(double rtol, double turns) const {
    return rtol * error_per_turn * turns * (1 + turns / secular) + floor_per_turn * turns;
  }

  /// The tolerance for a requested error.
  double find_rtol(double error, double turns) const {
    const double n = std::max(turns, 0.5);
    return error / (margin * error_per_turn * n * (1 + n / secular));
  }

  double compute_steps(double rtol, double turns, double stiffness) const {
    const double accurate = 1 + 2 * std::numbers::pi * turns * steps_per_radian * math::fast_pow(rtol, -power);
    return stability > 0.0 ? std::max(accurate, stiffness / stability) : accurate;
  }

  double compute_seconds(double rtol, double turns, double stiffness, double seconds_per_call) const {
    const double order = 2 - 0.5 * math::fast_log(rtol);
    return compute_steps(rtol, turns, stiffness) *
           (step_seconds + order_seconds * order * order + calls_per_step * seconds_per_call);
  }
};

}  // namespace polhode::ode
