#pragma once

#include <cmath>

#include "polhode/attitude/euler.hpp"

// What the functions of one attitude and those of arrays share, inside this word.
namespace polhode {

/// quat_from_matrix without the message: false where that would refuse.
bool try_quat_from_matrix(const Matrix3d& R_WB, Quat& q_WB);

/// euler_rates without the message: false at gimbal lock.
bool try_euler_rates(const EulerSequence& sequence, const Vector3d& angles, const Vector3d& w_B, Vector3d& angle_rates);

/// 1/|q| of the square of a norm that differs from 1 by rounding: one Newton step for 1/sqrt.
inline double back_to_unit(double square) { return 1.5 - 0.5 * square; }

/// The same, but 1 where the norm is as good as doubles can hold it, so that what is normalised moves no bit again.
inline double back_to_unit_if_off(double square) {
  return std::abs(square - 1.0) <= 0x1p-51 ? 1.0 : back_to_unit(square);
}

/// The quaternion x y z w of sines s and cosines c of the half angles, in intrinsic order (first, second, last):
/// products of q = (c0 + s0 e_first)(c1 + s1 e_second)(c2 + s2 e_last) with e_first e_second = sign e_other.
inline void compose(const EulerSequence& sequence, const double* s, const double* c, double* out) {
  const int i = sequence.first(), j = sequence.second(), k = sequence.other();
  const double cc = c[0] * c[2], ss = s[0] * s[2], sc = s[0] * c[2], cs = c[0] * s[2], e = sequence.sign();
  if (sequence.proper()) {
    out[i] = c[1] * (sc + cs);
    out[j] = s[1] * (cc + ss);
    out[k] = e * s[1] * (sc - cs);
    out[3] = c[1] * (cc - ss);
  } else {
    out[i] = c[1] * sc + e * s[1] * cs;
    out[j] = s[1] * cc - e * c[1] * ss;
    out[k] = c[1] * cs + e * s[1] * sc;
    out[3] = c[1] * cc - e * s[1] * ss;
  }
  const double scale = back_to_unit(out[0] * out[0] + out[1] * out[1] + out[2] * out[2] + out[3] * out[3]);
  for (int axis = 0; axis < 4; ++axis) out[axis] *= scale;
}

}  // namespace polhode
