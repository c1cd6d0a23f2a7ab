#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "polhode/ode/stepper.hpp"

namespace polhode::ode {

/// Steps of equal length. Their times are t0 + n h and do not drift. Only the last step of a run may be shorter. Far from
/// time zero those times are rounded coarsely, and each step then goes from one rounded time to the next.
class FixedStepper : public Stepper {
 public:
  StepResult advance(double t_end) final {
    const double rest = t_end - t_;
    // The rounding of t0 + n h must not leave a tiny last step.
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(t_), std::abs(t_end));
    const double h = std::copysign(step_, rest);
    const bool last = std::abs(rest) <= step_ + rounding;
    const double t_new = last ? t_end : t0_ + static_cast<double>(counts_.steps + 1) * h;
    h_taken_ = std::abs((t_new - t_) - h) <= time_rounding(t_new) ? h : t_new - t_;
    if (t_new == t_) return StepResult::underflow;
    if (const StepResult result = step(t_, h_taken_); result != StepResult::accepted) return result;
    t_old_ = t_;
    t_ = t_new;
    ++counts_.steps;
    return StepResult::accepted;
  }

 protected:
  FixedStepper(int size, int numbers_per_segment, Evaluate evaluate_segment, double t0, double length)
      : Stepper(size, numbers_per_segment, evaluate_segment, t0), t0_(t0), step_(length) {}

  /// One step of length h, negative when backward. The state changes only if the step is accepted.
  virtual StepResult step(double t, double h) = 0;

  double fraction(double t) const { return (t - t_old_) / (t_ - t_old_); }
  double h_taken() const { return h_taken_; }

  /// What n h itself is rounded by at time t, for any t0.
  double time_rounding(double t) const { return 4 * std::numeric_limits<double>::epsilon() * std::abs(t - t0_); }

 private:
  double t0_, step_, h_taken_ = 0.0;
};

}  // namespace polhode::ode
