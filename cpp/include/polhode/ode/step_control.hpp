#pragma once

#include <algorithm>
#include <cmath>

namespace polhode::ode {

/// The size of the next step from the error of the last: proportional-integral control, written once for every
/// embedded pair. Gustafsson 1991, ACM TOMS 17, 533; constants as in Hairer & Wanner 1996, Solving ODEs II, (IV.2.43).
class StepControl {
 public:
  /// @param error_order  order of the lower formula of the pair: the error goes as h^(error_order + 1)
  explicit StepControl(int error_order)
      : integral_(1.0 / (error_order + 1) - 0.75 * proportional_) {}

  /// Factor for the next step after one that was accepted with this error (1 is just acceptable).
  double accepted(double error) {
    double factor = largest_;
    if (error > 0) factor = safety_ * std::pow(error, -integral_) * std::pow(previous_, proportional_);
    factor = std::clamp(factor, smallest_, rejected_ ? 1.0 : largest_);
    previous_ = std::max(error, 1e-4);
    rejected_ = false;
    return factor;
  }

  /// Factor for another try after a step that was rejected; an error that is not a number shrinks the step most.
  double rejected(double error) {
    rejected_ = true;
    if (!std::isfinite(error)) return 0.1;
    return std::max(smallest_, safety_ * std::pow(error, -integral_));
  }

 private:
  static constexpr double safety_ = 0.9, smallest_ = 0.2, largest_ = 10.0, proportional_ = 0.04;
  double integral_;
  double previous_ = 1e-4;
  bool rejected_ = false;
};

}  // namespace polhode::ode
