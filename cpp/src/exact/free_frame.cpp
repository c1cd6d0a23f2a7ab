#include "exact/free_frame.hpp"

#include <cmath>
#include <numbers>

#include "polhode/math/detail/functions.hpp"

namespace polhode::exact {
namespace {

/// The shortest rotation that takes space z to the direction v.
Quat shortest_rotation_to(const Vector3d& v) {
  const Vector3d d = v.normalized();
  // (e_z + d) / |e_z + d| bisects; for d near -e_z any axis perpendicular to z serves, and x is taken.
  const double c = math::hypot(d[0], d[1]);
  if (d[2] < 0.0 && c < 1e-150) return {1.0, 0.0, 0.0, 0.0};
  if (c == 0.0) return {};
  const math::SinCosPair half = math::sincos(0.5 * math::atan2(c, d[2]));
  return {-d[1] / c * half.sin, d[0] / c * half.sin, 0.0, half.cos};
}

}  // namespace

int exponent_of(const Vector3d& v) { return std::ilogb(v.cwiseAbs().maxCoeff()); }

Vector3d ldexp(const Vector3d& v, int e) { return {std::ldexp(v[0], e), std::ldexp(v[1], e), std::ldexp(v[2], e)}; }

FreeFrame make_free_frame(const Matrix3d& R_BP, const Matrix3d& M, double time_scale, const Quat& first,
                          const Quat& attitude) {
  FreeFrame frame;
  frame.time_scale = time_scale;
  const Matrix3d S = R_BP * M;
  for (int c = 0; c < 3; ++c)
    for (int a = 0; a < 3; ++a) frame.omega[3 * c + a] = S(c, a) * time_scale;
  const auto in_body_axes = [&S](double x, double y, double z, double w) {
    const Vector3d v = S * Vector3d(x, y, z);
    return Quat{v[0], v[1], v[2], w};
  };
  const Quat left = normalized(attitude * conjugate(in_body_axes(first.x, first.y, first.z, first.w)));
  for (std::size_t i = 0; i < 4; ++i) {
    const Quat q = left * in_body_axes(i == 0, i == 1, i == 2, i == 3);
    frame.attitude[i] = q.x;
    frame.attitude[4 + i] = q.y;
    frame.attitude[8 + i] = q.z;
    frame.attitude[12 + i] = q.w;
  }
  return frame;
}

Vector3d euler_angles_about(const Vector3d& momentum_W, const Quat& q_WB) {
  const Quat q_LB = conjugate(shortest_rotation_to(momentum_W)) * q_WB;
  const double sum = math::atan2(q_LB.z, q_LB.w), difference = math::atan2(q_LB.y, q_LB.x);
  const double theta = 2.0 * math::atan2(math::hypot(q_LB.x, q_LB.y), math::hypot(q_LB.z, q_LB.w));
  constexpr double full_turn = 2.0 * std::numbers::pi;
  return {std::remainder(sum + difference, full_turn), theta, std::remainder(sum - difference, full_turn)};
}

}  // namespace polhode::exact
