#pragma once

#include <Eigen/Core>
#include <cmath>

#include "polhode/core/detail/float_flags.hpp"

namespace polhode {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Hamilton quaternion, scalar last, as in every array, file and signature of polhode.
/// As an attitude q_WB it maps body components to space components: v_W = q_WB (v_B, 0) conj(q_WB).
struct Quat {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  double w = 1.0;

  friend bool operator==(const Quat&, const Quat&) = default;
};

/// Hamilton product: the attitude of C in A from that of B in A and that of C in B.
inline Quat operator*(const Quat& q_AB, const Quat& q_BC) {
  const Quat &a = q_AB, &b = q_BC;
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

inline Quat conjugate(const Quat& q) { return {-q.x, -q.y, -q.z, q.w}; }

/// |q|, without overflow or underflow for any finite components.
double norm(const Quat& q);

/// q / |q|; the caller vouches for |q| > 0.
inline Quat normalized(const Quat& q) {
  const double n = norm(q);
  return {q.x / n, q.y / n, q.z / n, q.w / n};
}

/// R_WB of a unit quaternion q_WB. The diagonal is a sum of differences of squares, in which equal components cancel: a
/// quarter turn has exact zeros. Near 1 it is 1 minus squares instead, which keeps the digits of small angles.
inline Matrix3d to_matrix(const Quat& q) {
  const double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z, ww = q.w * q.w;
  const double xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
  const double wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
  const auto diagonal = [](double differences, double a, double b) {
    return differences > 0.5 ? 1 - 2 * (a + b) : differences;
  };
  Matrix3d R_WB;
  R_WB << diagonal((ww - zz) + (xx - yy), yy, zz), 2 * (xy - wz), 2 * (xz + wy),  //
      2 * (xy + wz), diagonal((ww - xx) + (yy - zz), xx, zz), 2 * (yz - wx),      //
      2 * (xz - wy), 2 * (yz + wx), diagonal((ww - yy) + (zz - xx), xx, yy);
  return R_WB;
}

/// v_W = q_WB v_B for a unit quaternion.
inline Vector3d rotate(const Quat& q_WB, const Vector3d& v_B) {
  const double tx = 2 * (q_WB.y * v_B[2] - q_WB.z * v_B[1]);
  const double ty = 2 * (q_WB.z * v_B[0] - q_WB.x * v_B[2]);
  const double tz = 2 * (q_WB.x * v_B[1] - q_WB.y * v_B[0]);
  return {v_B[0] + q_WB.w * tx + q_WB.y * tz - q_WB.z * ty, v_B[1] + q_WB.w * ty + q_WB.z * tx - q_WB.x * tz,
          v_B[2] + q_WB.w * tz + q_WB.x * ty - q_WB.y * tx};
}

/// Checks an attitude. A quaternion within 1e-6 of unit norm is normalised, any other is refused.
Quat make_attitude(const Quat& q);

}  // namespace polhode
