#pragma once

#include <algorithm>
#include <cmath>

namespace polhode::ode {

/// What a plan expects of an adaptive method: plain numbers, each good to a factor of two or so, fitted by
/// benchmarks/planner on random scenes. A method without them is never chosen by a plan.
struct Forecast {
  double error_per_turn =
      0.0;   ///< global error = rtol error_per_turn n (1 + n / secular) after n turns; 0: no forecast
  double secular = 30.0;           ///< turns after which the energy's drift shows in the phase
  double margin = 1.0;             ///< by which a plan's tolerance is finer: where that is cheaper than another try
  double floor_per_turn = 0.0;     ///< error per turn of rounding, whatever the tolerance
  double steps_per_radian = 0.0;   ///< at rtol = 1, with the power law ...
  double power = 0.0;              ///< ... steps = steps_per_radian rtol^-power
  double step_seconds = 0.0;       ///< of a step, with a built-in torque
  double order_seconds = 0.0;   ///< and that much times (2 - ln(rtol) / 2)^2: methods whose order follows the tolerance
  double calls_per_step = 0.0;     ///< of the torque
  double stability = 0.0;          ///< largest (rate of decay) x step; 0: any (implicit methods)

  bool known() const { return error_per_turn > 0.0; }

  double compute_error(double rtol, double turns) const {
    return rtol * error_per_turn * turns * (1 + turns / secular) + floor_per_turn * turns;
  }

  /// The tolerance to take for this error.
  double find_rtol(double error, double turns) const {
    const double n = std::max(turns, 0.5);
    return error / (margin * error_per_turn * n * (1 + n / secular));
  }

  double compute_steps(double rtol, double turns, double stiffness) const {
    const double accurate = 1 + 6.283185307179586 * turns * steps_per_radian * std::pow(rtol, -power);
    return stability > 0.0 ? std::max(accurate, stiffness / stability) : accurate;
  }

  double compute_seconds(double rtol, double turns, double stiffness, double seconds_per_call) const {
    const double order = 2 - 0.5 * std::log(rtol);
    return compute_steps(rtol, turns, stiffness) *
           (step_seconds + order_seconds * order * order + calls_per_step * seconds_per_call);
  }
};

}  // namespace polhode::ode
