#include "polhode/math/detail/double_double.hpp"

#include <limits>

#include "polhode/math/detail/dd_functions.hpp"

namespace polhode::math {

SinCos sincos(DD angle) {
  const SinCosOf<double> s = sincos_dd(angle);
  return {s.sin, s.cos};
}

DD exp(DD x) {
  if (x.hi > 709.7) return DD(std::numeric_limits<double>::infinity());
  if (!(x.hi > -746.0)) return DD(0.0);
  // In two halves where one power of two would not do.
  const DD half = exp_dd(scaled(x, 0.5));
  return std::abs(x.hi) < 690.0 ? exp_dd(x) : half * half;
}

DD log(DD x) {
  int k = 0;
  std::frexp(x.hi, &k);
  if (std::abs(k) < 900) return log_dd(x);
  const DD ln2{0.6931471805599453, 2.3190468138462996e-17};
  return log_dd(DD(std::ldexp(x.hi, -k), std::ldexp(x.lo, -k))) + ln2 * DD(static_cast<double>(k));
}

DD atan2(DD y, DD x) { return atan2_dd(y, x); }

}  // namespace polhode::math
