#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace polhode::ode {

/// log2(x) for 0 < x < infinity to 1e-3, in two parts: the exact exponent, and a cubic for the mantissa. Differences do
/// not change when both numbers are multiplied by a power of two.
struct RoughLog2 {
  int exponent;
  double mantissa;

  RoughLog2() = default;
  explicit RoughLog2(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const double m = std::bit_cast<double>((bits & 0x000fffffffffffffu) | 0x3ff0000000000000u) - 1.0;
    exponent = static_cast<int>(bits >> 52) - 1023;
    mantissa = m * (1.4249 + m * (-0.5797 + m * 0.1548));
  }
  friend double operator-(RoughLog2 a, RoughLog2 b) { return (a.exponent - b.exponent) + (a.mantissa - b.mantissa); }
};

inline double rough_log2(double x) {
  const RoughLog2 log(x);
  return log.exponent + log.mantissa;
}

/// 2^x to 1e-3 for |x| <= 1000. Beyond, x counts as 1000 or -1000.
inline double rough_exp2(double x) {
  const double p = std::clamp(x, -1000.0, 1000.0);
  const int whole = static_cast<int>(p + 1024.0) - 1024;   // floor, without a call
  const double f = p - whole;
  const double scale = std::bit_cast<double>(static_cast<std::uint64_t>(whole + 1023) << 52);
  return scale * (1.0 + f * (0.6951 + f * (0.2276 + f * 0.0773)));
}

/// The step from t that ends at a number: the time t + h is rounded, and a step of h itself would miss it. The difference
/// is half a unit in the last place of t a step, which matters where times lie close together and far from zero.
inline double representable_step(double t, double h) {
  return (t + h) - t;
}

/// x^y for 0 < x < infinity to 1e-3. It is enough for a step size and costs a tenth of std::pow.
inline double rough_power(double x, double y) { return rough_exp2(y * rough_log2(x)); }

/// Chooses the next step from the error of the last by proportional-integral control, for every embedded pair.
/// Gustafsson 1991, ACM TOMS 17, 533; constants as in Hairer & Wanner 1996, Solving ODEs II, (IV.2.43).
class StepControl {
 public:
  /// @param error_order  order of the lower formula of the pair: the error goes as h^(error_order + 1)
  explicit StepControl(int error_order)
      : integral_(integral(error_order)) {}

  static constexpr double safety = 0.9, smallest = 0.2, largest = 10.0, proportional = 0.04, least_error = 1e-4;
  static constexpr double integral(int error_order) { return 1.0 / (error_order + 1) - 0.75 * proportional; }

  /// Factor for the next step after a step accepted with this error (1 is just acceptable).
  double accepted(double error) {
    double factor = largest;
    if (error > 0) factor = safety * rough_power(error, -integral_) * rough_power(previous_, proportional);
    factor = std::clamp(factor, smallest, rejected_ ? 1.0 : largest);
    previous_ = std::max(error, least_error);
    rejected_ = false;
    return factor;
  }

  /// Factor for another attempt after a rejected step. An error that is not finite shrinks the step most.
  double rejected(double error) {
    rejected_ = true;
    if (!std::isfinite(error)) return 0.1;
    return std::max(smallest, safety * rough_power(error, -integral_));
  }

 private:
  double integral_;
  double previous_ = least_error;
  bool rejected_ = false;
};

}  // namespace polhode::ode
