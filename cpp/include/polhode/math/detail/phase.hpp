#pragma once

#include "polhode/math/detail/double_double.hpp"

namespace polhode::math {

/// t rate + start in cycles, less whole turns: at most 3/2 for |start| <= 1/2. `sincos_cycles` needs no more.
/// The rate (cycles a second) is a double-double, so the error is about 1e-32 |t rate| + 1e-17 cycles.
template <class T>
POLHODE_INLINE T few_cycles(T t, T rate_hi, T rate_lo, T start) {
  const auto p = two_prod(t, rate_hi);
  return (p.hi - rint(p.hi)) + (madd(t, rate_lo, p.lo) + start);
}

/// The fraction in [-1/2, 1/2] of the same: what an angle keeps after any number of turns.
template <class T>
POLHODE_INLINE T cycle_fraction(T t, T rate_hi, T rate_lo, T start) {
  const T f = few_cycles(t, rate_hi, rate_lo, start);
  return f - rint(f);
}

}  // namespace polhode::math
