#pragma once

#include "polhode/torque/vertical.hpp"

// The formulas of the torques over a number type: one body, or many bodies in the lanes of registers. Both have the
// same operations in the same order, and so the same bits. Plain arrays; matrices by columns, as Eigen stores them.
namespace polhode {

/// (M v)_i of a 3 x 3 matrix.
template <class N>
POLHODE_INLINE N row_product(const N* M, int i, const N* v) {
  return M[i] * v[0] + M[3 + i] * v[1] + M[6 + i] * v[2];
}

/// tau_B += r x (-m g g_B), with the moment m g r.
template <class N>
POLHODE_INLINE void add_weight(const N* moment_B, const N* q, N* tau_B) {
  N g[3];
  compute_vertical(q, g);
  tau_B[0] = tau_B[0] - (moment_B[1] * g[2] - moment_B[2] * g[1]);
  tau_B[1] = tau_B[1] - (moment_B[2] * g[0] - moment_B[0] * g[2]);
  tau_B[2] = tau_B[2] - (moment_B[0] * g[1] - moment_B[1] * g[0]);
}

/// tau_B -= C w_B
template <class N>
POLHODE_INLINE void add_damping(const N* C, const N* w_B, N* tau_B) {
  for (int i = 0; i < 3; ++i) tau_B[i] = tau_B[i] - row_product(C, i, w_B);
}

/// tau_B += h x w_B: the gyroscopic torque of rotors with the momentum h, which is constant in the body.
template <class N>
POLHODE_INLINE void add_rotors(const N* h_B, const N* w_B, N* tau_B) {
  tau_B[0] = tau_B[0] + (h_B[1] * w_B[2] - h_B[2] * w_B[1]);
  tau_B[1] = tau_B[1] + (h_B[2] * w_B[0] - h_B[0] * w_B[2]);
  tau_B[2] = tau_B[2] + (h_B[0] * w_B[1] - h_B[1] * w_B[0]);
}

/// u_B = R_WB^T (cos a, sin a, 0), from any positive multiple of a unit quaternion.
template <class N>
POLHODE_INLINE void compute_radial(N cosine, N sine, const N* q, N* u_B) {
  const N x = q[0], y = q[1], z = q[2], w = q[3], two(2.0);
  const N xx = x * x, yy = y * y, zz = z * z, ww = w * w;
  const N unit = N(1.0) / (xx + yy + zz + ww);
  const N c = cosine * unit, s = sine * unit;
  u_B[0] = c * (ww + xx - yy - zz) + s * (two * (x * y + w * z));   // rows x and y of R_WB
  u_B[1] = c * (two * (x * y - w * z)) + s * (ww - xx + yy - zz);
  u_B[2] = c * (two * (x * z + w * y)) + s * (two * (y * z - w * x));
}

/// tau_B += strength u x (I u); `principal`: I is diagonal.
template <bool principal, class N>
POLHODE_INLINE void add_gradient(N strength, const N* I, const N* u, N* tau_B) {
  if constexpr (principal) {
    tau_B[0] = tau_B[0] + strength * (I[8] - I[4]) * (u[1] * u[2]);
    tau_B[1] = tau_B[1] + strength * (I[0] - I[8]) * (u[2] * u[0]);
    tau_B[2] = tau_B[2] + strength * (I[4] - I[0]) * (u[0] * u[1]);
  } else {
    const N h[3] = {row_product(I, 0, u), row_product(I, 1, u), row_product(I, 2, u)};
    tau_B[0] = tau_B[0] + strength * (u[1] * h[2] - u[2] * h[1]);
    tau_B[1] = tau_B[1] + strength * (u[2] * h[0] - u[0] * h[2]);
    tau_B[2] = tau_B[2] + strength * (u[0] * h[1] - u[1] * h[0]);
  }
}

}  // namespace polhode
