#pragma once

#include "polhode/math/detail/double_double.hpp"

namespace polhode::math {

/// An angle as quarter turns and a rest: angle = quarters pi / 2 + rest, |rest| <= pi / 4 (1 + 1e-10).
struct QuarterTurns {
  double rest, low;    ///< rest + low, relative error below 2^-64
  unsigned quarters;   ///< modulo 4
};

/// For 1 <= |angle| < infinity, at some 50 ns.
QuarterTurns reduce_exactly(double angle);

}  // namespace polhode::math
