#pragma once

#include "polhode/math/detail/number.hpp"

namespace polhode::math {

/// e^-x for x >= 0, relative error about 2e-16, without libm or branches; 3e-308 beyond x = 708.
/// Cody & Waite's two-part reduction by ln 2, then the Taylor polynomial of degree 13 on |r| <= ln(2) / 2.
template <class T>
POLHODE_INLINE T exp_minus(T x) {
  constexpr double c[] = {
      1.0,        1.0,         1.0 / 2,      1.0 / 6,       1.0 / 24,       1.0 / 120,       1.0 / 720,
      1.0 / 5040, 1.0 / 40320, 1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800};
  x = min(x, T(708.0));
  const T n = rint(x * T(1.4426950408889634));
  const T r = madd(n, T(1.9082149292705877e-10), n * T(0x1.62e42fee00000p-1) - x);
  return polynomial(c, r) * power_of_two(-n);
}

/// e^-x and e^x for 0 <= x <= 708, each within 3e-16, at the price of one: they share the powers of r.
template <class T>
POLHODE_INLINE void exp_both(T x, T& minus, T& plus) {
  constexpr double even[] = {1.0, 1.0 / 2, 1.0 / 24, 1.0 / 720, 1.0 / 40320, 1.0 / 3628800, 1.0 / 479001600};
  constexpr double odd[] = {1.0,          1.0 / 6,        1.0 / 120,       1.0 / 5040,
                            1.0 / 362880, 1.0 / 39916800, 1.0 / 6227020800};
  x = min(x, T(708.0));
  const T n = rint(x * T(1.4426950408889634));
  const T r = madd(n, T(1.9082149292705877e-10), n * T(0x1.62e42fee00000p-1) - x), r2 = r * r;
  const T cosh = polynomial(even, r2), sinh = r * polynomial(odd, r2);
  minus = (cosh + sinh) * power_of_two(-n);
  plus = (cosh - sinh) * power_of_two(n);
}

}  // namespace polhode::math
