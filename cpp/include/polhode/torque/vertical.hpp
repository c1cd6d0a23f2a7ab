#pragma once

namespace polhode {

/// g_B = R_WB^T e_z, the space vertical in body axes. The stages of a step are quaternions that are unit up to the
/// error of the step alone; R is formed as a quadratic form, so that no division is needed.
inline void compute_vertical(const double* q, double* g_B) {
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  g_B[0] = 2 * (x * z - w * y);
  g_B[1] = 2 * (y * z + w * x);
  g_B[2] = z * z + w * w - x * x - y * y;
}

/// v_B = R_WB^T v_W.
inline void to_body(const double* q, const double* v_W, double* v_B) {
  const double x = -q[0], y = -q[1], z = -q[2], w = q[3];
  const double tx = y * v_W[2] - z * v_W[1], ty = z * v_W[0] - x * v_W[2], tz = x * v_W[1] - y * v_W[0];
  v_B[0] = v_W[0] + 2 * (w * tx + y * tz - z * ty);
  v_B[1] = v_W[1] + 2 * (w * ty + z * tx - x * tz);
  v_B[2] = v_W[2] + 2 * (w * tz + x * ty - y * tx);
}

}  // namespace polhode
