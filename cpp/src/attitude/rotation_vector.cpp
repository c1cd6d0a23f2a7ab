#include "polhode/attitude/rotation_vector.hpp"

#include <cmath>

#include "polhode/math/detail/functions.hpp"

namespace polhode {

Quat quat_from_rotation_vector(const Vector3d& v) {
  const double square = v.squaredNorm();
  double scale, w;  // sin(|v|/2)/|v| and cos(|v|/2)
  if (square < 1e-4) {
    // Taylor: the first terms left out are 1e-20 of the sum, and no |v| is needed that could underflow.
    scale = 0.5 - square * (1.0 / 48 - square * (1.0 / 3840 - square / 645120));
    w = 1.0 - square * (1.0 / 8 - square * (1.0 / 384 - square / 46080));
  } else {
    const double angle = square < 1e300 ? std::sqrt(square) : math::hypot(v[0], v[1], v[2]);
    const math::SinCosPair half = math::sincos(0.5 * angle);
    scale = half.sin / angle;
    w = half.cos;
  }
  return {scale * v[0], scale * v[1], scale * v[2], w};
}

Quat canonical(const Quat& q) {
  const double lead = q.w != 0.0 ? q.w : q.x != 0.0 ? q.x : q.y != 0.0 ? q.y : q.z;
  // 0 + x turns -0 into 0, so that equal attitudes are equal bits.
  return lead < 0.0 ? Quat{0.0 - q.x, 0.0 - q.y, 0.0 - q.z, 0.0 - q.w}
                    : Quat{0.0 + q.x, 0.0 + q.y, 0.0 + q.z, 0.0 + q.w};
}

Vector3d to_rotation_vector(const Quat& q_WB) {
  const Quat q = canonical(q_WB);
  const double square = q.x * q.x + q.y * q.y + q.z * q.z;
  double scale = 2.0 / q.w;  // below 1e-100 the angle is twice the sine of its half
  if (square > 1e-200) {
    const double sine = std::sqrt(square);
    scale = 2.0 * math::atan2(sine, q.w) / sine;
  }
  return {scale * q.x, scale * q.y, scale * q.z};
}

double rotation_angle(const Quat& q_WB) {
  const double square = q_WB.x * q_WB.x + q_WB.y * q_WB.y + q_WB.z * q_WB.z;
  const double sine = square > 1e-200 ? std::sqrt(square) : math::hypot(q_WB.x, q_WB.y, q_WB.z);
  return 2.0 * math::atan2(sine, std::abs(q_WB.w));
}

}  // namespace polhode
