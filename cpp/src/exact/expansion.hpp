#pragma once

#include "polhode/math/detail/double_double.hpp"

// Exact sums by expansions. Shewchuk 1997, "Adaptive precision floating-point arithmetic", Discrete Comput. Geom. 18,
// 305.
namespace polhode::exact {

/// A sum of doubles that do not overlap, smallest first; exact.
struct Expansion {
  double term[48];
  int size = 0;

  void add(double b) {
    double carry = b;
    int kept = 0;
    for (int i = 0; i < size; ++i) {
      const math::DD s = math::two_sum(carry, term[i]);
      carry = s.hi;
      if (s.lo != 0.0) term[kept++] = s.lo;
    }
    if (carry != 0.0 || kept == 0) term[kept++] = carry;
    size = kept;
  }

  bool is_zero() const { return size == 0 || (size == 1 && term[0] == 0.0); }
};

}  // namespace polhode::exact
