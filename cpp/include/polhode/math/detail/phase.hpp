#pragma once

#include "polhode/math/detail/double_double.hpp"

namespace polhode::math {

/// The fraction in [-1/2, 1/2] of t rate + start, in cycles: what an angle keeps after any number of turns.
/// The rate (cycles a second) is a double-double, so the error is about 1e-32 |t rate| + 1e-17 cycles.
template <class T>
POLHODE_INLINE T cycle_fraction(T t, T rate_hi, T rate_lo, T start) {
  const auto p = two_prod(t, rate_hi);
  const T f = (p.hi - rint(p.hi)) + (madd(t, rate_lo, p.lo) + start);
  return f - rint(f);
}

}  // namespace polhode::math
