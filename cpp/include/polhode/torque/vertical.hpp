#pragma once

#include "polhode/math/detail/number.hpp"

namespace polhode {

/// g_B = R_WB^T e_z, the space vertical in body axes, from any positive multiple of a unit quaternion. Homogeneous in
/// q on purpose: the stages of a step are not unit quaternions, and a formula for unit quaternions doubles the error.
template <class N>
POLHODE_INLINE void compute_vertical(const N* q, N* g_B) {
  const N x = q[0], y = q[1], z = q[2], w = q[3], two(2.0);
  const N xx = x * x, yy = y * y, zz = z * z, ww = w * w;
  const N s = N(1.0) / (xx + yy + zz + ww);
  g_B[0] = two * (x * z - w * y) * s;
  g_B[1] = two * (y * z + w * x) * s;
  g_B[2] = (zz + ww - xx - yy) * s;
}

/// v_B = R_WB^T v_W, from any positive multiple of a unit quaternion.
template <class N>
POLHODE_INLINE void to_body(const N* q, const N* v_W, N* v_B) {
  const N x = -q[0], y = -q[1], z = -q[2], w = q[3];
  const N s = N(2.0) / (x * x + y * y + z * z + w * w);
  const N tx = y * v_W[2] - z * v_W[1], ty = z * v_W[0] - x * v_W[2], tz = x * v_W[1] - y * v_W[0];
  v_B[0] = v_W[0] + s * (w * tx + y * tz - z * ty);
  v_B[1] = v_W[1] + s * (w * ty + z * tx - x * tz);
  v_B[2] = v_W[2] + s * (w * tz + x * ty - y * tx);
}

}  // namespace polhode
