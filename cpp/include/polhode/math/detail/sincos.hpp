#pragma once

#include "polhode/math/detail/number.hpp"

namespace polhode::math {

/// sin and cos of 2 pi f for |f| <= 100 turns, each within 1.7e-16 (1.2e-16 with a fused multiply-add), without libm or
/// branches. Polynomials: minimax on 1/8 turn (Remez exchange at 60 digits), 5e-20 in exact arithmetic.
template <class T>
POLHODE_INLINE void sincos_cycles(T f, T& sine, T& cosine) {
  constexpr double s[] = {-41.34170224039976, 81.60524927607504,  -76.70585975304293, 42.05869393780828,
                          -15.094641279892077, 3.81983076146553, -0.7124444307432821};
  constexpr double c[] = {-19.739208802178716, 64.93939402266824, -85.45681720664383, 60.24464135270976,
                          -26.426253276795496, 7.903206964334389, -1.6990355062994194};
  const T turns = f + T(0x1.8p50);           // rounds f to quarters: the last bit of such numbers counts 1/4
  const T r = f - (turns - T(0x1.8p50));     // exact
  const T y = r * r;
  const T sr = madd(r, T(6.283185307179586), r * madd(y, polynomial(s, y), T(2.4492935982947064e-16)));
  const T cr = madd(y, polynomial(c, y), T(1.0));
  add_quarters(turns, sr, cr, sine, cosine);
}

}  // namespace polhode::math
