#pragma once

#include "polhode/math/detail/number.hpp"

namespace polhode::math {

/// The largest angle that `sincos_unfused` takes [rad].
inline constexpr double most_unfused_angle = 1e5;

/// sin and cos of x radians, |x| <= most_unfused_angle, each within 1.4e-16, without fused operations: one number and
/// many in lanes get the same bits at every level of instructions. Reduced by pi/2 in parts of 33 bits (Cody & Waite
/// 1980), whose products with that many quarter turns are exact. Polynomials: Chebyshev fits at 50 digits, 2e-17.
template <class T>
POLHODE_INLINE void sincos_unfused(T x, T& sine, T& cosine) {
  constexpr double s[] = {-0.16666666666666666,  0.008333333333330936,    -0.00019841269836740532,
                          2.7557316093198404e-06, -2.5051129896450185e-08, 1.5917988979397435e-10};
  constexpr double c[] = {0.04166666666666664,     -0.0013888888888880734, 2.480158729366189e-05,
                          -2.7557315555381283e-07, 2.0875885001628906e-09, -1.136789634714201e-11};
  const T n = rint(x * T(0.6366197723675814)), quadrant = n - T(4.0) * rint(n * T(0.25));   // -2 ... 2
  const T first = x - n * T(0x1.921fb544p+0), second = n * T(0x1.0b4611a6p-34);   // exact
  const T r = first - second, low = ((first - r) - second) - n * T(0x1.3198a2e037073p-69);
  const T y = r * r, half = T(0.5) * y, near = T(1.0) - half;
  T sp(s[5]), cp(c[5]);
  for (int i = 5; i-- > 0;) sp = sp * y + T(s[i]), cp = cp * y + T(c[i]);
  const T sr = r + (r * (y * sp) + low), cr = near + (((T(1.0) - near) - half) + (y * y * cp - r * low));
  const T size = abs(quadrant), even = T(1.0) - size;   // 1 for 0, -1 for a half turn
  const auto odd = size == T(1.0);
  sine = select(odd, quadrant * cr, even * sr);
  cosine = select(odd, -(quadrant * sr), even * cr);
}

}  // namespace polhode::math
