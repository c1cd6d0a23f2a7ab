#pragma once

namespace polhode {

/// g_B = R_WB^T e_z, the space vertical in body axes, from any positive multiple of a unit quaternion. Homogeneous on
/// purpose: the stages of a step are not unit quaternions, and a form that takes them for such doubles the error.
inline void compute_vertical(const double* q, double* g_B) {
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  const double xx = x * x, yy = y * y, zz = z * z, ww = w * w;
  const double s = 1.0 / (xx + yy + zz + ww);
  g_B[0] = 2 * (x * z - w * y) * s;
  g_B[1] = 2 * (y * z + w * x) * s;
  g_B[2] = (zz + ww - xx - yy) * s;
}

/// v_B = R_WB^T v_W, from any positive multiple of a unit quaternion.
inline void to_body(const double* q, const double* v_W, double* v_B) {
  const double x = -q[0], y = -q[1], z = -q[2], w = q[3];
  const double s = 2.0 / (x * x + y * y + z * z + w * w);
  const double tx = y * v_W[2] - z * v_W[1], ty = z * v_W[0] - x * v_W[2], tz = x * v_W[1] - y * v_W[0];
  v_B[0] = v_W[0] + s * (w * tx + y * tz - z * ty);
  v_B[1] = v_W[1] + s * (w * ty + z * tx - x * tz);
  v_B[2] = v_W[2] + s * (w * tz + x * ty - y * tx);
}

}  // namespace polhode
