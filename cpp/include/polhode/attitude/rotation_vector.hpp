#pragma once

#include "polhode/core/quat.hpp"

namespace polhode {

/// q_WB of the rotation by |v| about v, (v sin(|v|/2)/|v|, cos(|v|/2)): exact to rounding down to the smallest v.
/// The vector must be finite; it has the same components in W and in B.
Quat quat_from_rotation_vector(const Vector3d& v);

/// The shortest rotation vector of a unit quaternion, |v| <= pi; at |v| = pi exactly (w = 0), where v and -v are the
/// same attitude, the one whose first non-zero component is positive.
Vector3d to_rotation_vector(const Quat& q_WB);

/// Its length, the angle of the rotation in [0, pi] [rad].
double rotation_angle(const Quat& q_WB);

/// Of q and -q, the one with w > 0; for w = 0 the one whose first non-zero component is positive.
Quat canonical(const Quat& q);

}  // namespace polhode
