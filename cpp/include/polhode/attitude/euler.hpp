#pragma once

#include <string>
#include <string_view>

#include "polhode/core/quat.hpp"

namespace polhode {

/// One of the 24 Euler sequences, in SciPy's letters: upper case intrinsic (each rotation about the axes as rotated so
/// far), lower case extrinsic (about the fixed axes). "ZXZ" is the textbook's (phi, theta, psi), "ZYX" yaw pitch roll.
///
/// An extrinsic sequence is the intrinsic one read backwards. All members describe that intrinsic form,
/// R_WB = R_first(a) R_second(b) R_last(c).
class EulerSequence {
 public:
  /// Three letters, neighbours different; InvalidInput otherwise.
  explicit EulerSequence(std::string_view letters);

  int first() const noexcept { return first_; }        ///< axis 0, 1, 2 of the first rotation
  int second() const noexcept { return second_; }      ///< axis of the middle rotation
  int other() const noexcept { return other_; }        ///< the axis that is neither
  int last() const noexcept { return proper_ ? first_ : other_; }
  bool proper() const noexcept { return proper_; }     ///< first = last ("ZXZ"): locks at 0 and pi, else at +-pi/2
  bool extrinsic() const noexcept { return extrinsic_; }
  double sign() const noexcept { return sign_; }       ///< e_first x e_second = sign e_other
  std::string letters() const;

 private:
  int first_, second_, other_;
  bool proper_, extrinsic_;
  double sign_;
};

/// q_WB of three angles [rad], in the order of the sequence's letters.
Quat quat_from_euler(const EulerSequence& sequence, const Vector3d& angles);

/// The angles [rad] of a unit quaternion in the order of the letters: the outer ones in [-pi, pi], the middle one in
/// [0, pi] (first = last) or [-pi/2, pi/2]. Their matrix is that of q_WB to rounding at any distance from the pole.
/// At gimbal lock (see below) the third angle is 0 and the middle one that of the pole.
Vector3d to_euler(const EulerSequence& sequence, const Quat& q_WB);

/// True where q_WB leaves only the sum or the difference of the outer angles: where the middle angle is within
/// 4 ulp(1) = 8.9e-16 rad of a pole, the rounding that a unit quaternion carries anyway.
bool gimbal_lock(const EulerSequence& sequence, const Quat& q_WB);

}  // namespace polhode
