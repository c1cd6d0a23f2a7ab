#pragma once

#include "polhode/math/detail/number.hpp"

namespace polhode::math {

/// The angle of (x, y) in cycles, in [-1/2, 1/2], within 1e-16, without libm or branches; 0 for (0, 0).
/// One quotient in [-tan(pi/8), tan(pi/8)], then a minimax polynomial (Remez exchange at 60 digits, 3e-20).
template <class T>
POLHODE_INLINE T atan2_cycles(T y, T x) {
  constexpr double c[] = {-0.05305164769729845,  0.031830988618378776, -0.0227364204416169,   0.01768388255667175,
                          -0.014468630671047561, 0.012242670403423266, -0.010609952947623076, 0.00935669541493301,
                          -0.00832515041704678,  0.007246792083596705, -0.005508711291509179, 0.002598984277801184};
  const T zero(0.0), ax = abs(x), ay = abs(y);
  const T large = max(ax, ay), small = min(ax, ay);
  const auto steep = small > T(0.41421356237309503) * large;
  const T numerator = select(steep, small - large, small), denominator = select(steep, small + large, large);
  const T t = numerator / select(denominator == zero, T(1.0), denominator);
  const T t2 = t * t;
  T angle = t * madd(t2, polynomial(c, t2), T(0.15915494309189535));
  angle = select(steep, angle + T(0.125), angle);
  angle = select(ay > ax, T(0.25) - angle, angle);
  angle = select(x < zero, T(0.5) - angle, angle);
  return copysign(angle, y);
}

}  // namespace polhode::math
