#pragma once

#include "polhode/math/detail/number.hpp"

namespace polhode::math {

/// sin and cos of 2 pi f for |f| <= 1/2 turn, each within 1.7e-16 (1.2e-16 with a fused multiply-add), without libm or
/// branches. Polynomials: minimax on 1/8 turn (Remez exchange at 60 digits), 5e-20 in exact arithmetic.
template <class T>
POLHODE_INLINE void sincos_cycles(T f, T& sine, T& cosine) {
  constexpr double s[] = {-41.34170224039976, 81.60524927607504,  -76.70585975304293, 42.05869393780828,
                          -15.094641279892077, 3.81983076146553, -0.7124444307432821};
  constexpr double c[] = {-19.739208802178716, 64.93939402266824, -85.45681720664383, 60.24464135270976,
                          -26.426253276795496, 7.903206964334389, -1.6990355062994194};
  const T quadrant = rint(T(4.0) * f);              // -2 ... 2
  const T r = madd(T(-0.25), quadrant, f);           // exact
  const T y = r * r;
  const T sr = madd(r, T(6.283185307179586), r * madd(y, polynomial(s, y), T(2.4492935982947064e-16)));
  const T cr = madd(y, polynomial(c, y), T(1.0));
  const T size = abs(quadrant), even = T(1.0) - size;  // 1 for 0, -1 for a half turn
  const auto odd = size == T(1.0);
  sine = select(odd, quadrant * cr, even * sr);
  cosine = select(odd, -(quadrant * sr), even * cr);
}

}  // namespace polhode::math
