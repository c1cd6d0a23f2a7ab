#pragma once

#include <algorithm>
#include <cmath>

#include "polhode/core/quat.hpp"
#include "polhode/exact/detail/free_kernels.hpp"

// Between the body axes B, the principal axes P and the working axes of the series, for FreeMotion and its batch.
namespace polhode::exact {

/// e with the largest |v_i| in [2^e, 2^(e + 1)).
int exponent_of(const Vector3d& v);

/// Whether the ratio of the least moment to the largest is at least 2^-511: its square is then a normal float64.
inline bool carries_moments(const double* I) {
  return std::min({I[0], I[1], I[2]}) >= 0x1p-511 * std::max({I[0], I[1], I[2]});
}

/// Whether each rate is 0 or at least 2^-950 of the largest: products with differences of moments are then normal float64.
inline bool carries_rates(const double* w) {
  const double least = 0x1p-950 * std::max({std::abs(w[0]), std::abs(w[1]), std::abs(w[2])});
  const auto carried = [least](double rate) { return rate == 0.0 || std::abs(rate) >= least; };
  return carried(w[0]) && carried(w[1]) && carried(w[2]);
}

/// 2^e v.
Vector3d ldexp(const Vector3d& v, int e);

/// Q(0) of a series, in working axes.
template <class Series>
Quat first_attitude(const Series& series) {
  const FreeState<double> state = evaluate(series, 0.0);
  return {state.x, state.y, state.z, state.w};
}

/// All constant rotations in two matrices: omega = time_scale S omega' and q = q0 conj(S Q(0)) (S Q'), S = R_BP M.
/// M is the rotation from working to principal axes, `first` is Q(0) and `attitude` is q0.
FreeFrame make_free_frame(const Matrix3d& R_BP, const Matrix3d& M, double time_scale, const Quat& first,
                          const Quat& attitude);

/// (phi, theta, psi), intrinsic z-x-z, of the body axes in a space frame whose z axis is the momentum (space z rotated to
/// it the shortest way).
Vector3d euler_angles_about(const Vector3d& momentum_W, const Quat& q_WB);

}  // namespace polhode::exact
