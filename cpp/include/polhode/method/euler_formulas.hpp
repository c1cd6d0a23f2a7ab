#pragma once

#include "polhode/torque/formulas.hpp"

// Euler's equations over a number type, like torque/formulas.hpp. EulerProblem and bodies in lanes share them.
namespace polhode {

/// w' = I^-1 (tau + (I w) x w) in principal axes; difference: (I2 - I3, I3 - I1, I1 - I2).
template <class N>
POLHODE_INLINE void compute_rate_change(const N* difference, const N* inverse_moment, const N* w, const N* tau, N* f) {
  f[0] = (difference[0] * w[1] * w[2] + tau[0]) * inverse_moment[0];
  f[1] = (difference[1] * w[2] * w[0] + tau[1]) * inverse_moment[1];
  f[2] = (difference[2] * w[0] * w[1] + tau[2]) * inverse_moment[2];
}

/// The same in any axes, with I and its inverse by columns.
template <class N>
POLHODE_INLINE void compute_rate_change_skew(const N* I, const N* inverse, const N* w, const N* tau, N* f) {
  const N L[3] = {row_product(I, 0, w), row_product(I, 1, w), row_product(I, 2, w)};
  const N sum[3] = {tau[0] + (L[1] * w[2] - L[2] * w[1]), tau[1] + (L[2] * w[0] - L[0] * w[2]),
                    tau[2] + (L[0] * w[1] - L[1] * w[0])};
  for (int i = 0; i < 3; ++i) f[i] = row_product(inverse, i, sum);
}

/// q' = q (w, 0) / 2
template <class N>
POLHODE_INLINE void compute_attitude_rate(const N* q, const N* w, N* f) {
  const N half(0.5), a = half * w[0], b = half * w[1], c = half * w[2];
  f[0] = q[3] * a + q[1] * c - q[2] * b;
  f[1] = q[3] * b + q[2] * a - q[0] * c;
  f[2] = q[3] * c + q[0] * b - q[1] * a;
  f[3] = -(q[0] * a + q[1] * b + q[2] * c);
}

template <class N>
POLHODE_INLINE N sum_sizes(const N* v, int n) {
  using math::abs;
  N total(0.0);
  for (int i = 0; i < n; ++i) total = total + abs(v[i]);
  return total;
}

/// The error of a step of (w, q) or w alone; up to 1 the step is accepted. Rates and quaternion are measured
/// separately, because only rates have a unit. Sums of magnitudes are NaN if any term is.
template <bool with_attitude, class N>
POLHODE_INLINE N compute_error_norm(const N* error, const N* y0, const N* y1, N rtol, N atol) {
  using math::abs;
  using math::select;
  const N before = sum_sizes(y0, 3), after = sum_sizes(y1, 3), size = select(before < after, after, before);
  const N e = sum_sizes(error, 3), rates = select(e == N(0.0), N(0.0), e / (rtol * size + atol));
  if constexpr (with_attitude) {
    const N angle = (sum_sizes(error + 3, 3) + abs(error[6])) / (rtol + atol);
    return select(rates > angle, rates, select(rates == rates, angle, rates));
  } else {
    return rates;
  }
}

/// 1/|q|. For |q|^2 within 1e-8 of 1 the tangent is exact to rounding.
template <class N>
POLHODE_INLINE N compute_unit_scale(const N* q) {
  using math::abs;
  using math::any;
  using math::select;
  using math::sqrt;
  const N n = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  const N off = abs(n - N(1.0)), tangent = N(1.5) - N(0.5) * n, near(1e-8);
  if (!any(near <= off)) return tangent;
  return select(off < near, tangent, N(1.0) / sqrt(n));
}

}  // namespace polhode
