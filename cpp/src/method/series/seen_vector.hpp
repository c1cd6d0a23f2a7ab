#pragma once

#include <array>

#include "polhode/core/quat.hpp"
#include "polhode/math/detail/double_double.hpp"

namespace polhode {

/// v_B = R_WB^T v_W of the unit quaternion along q_WB, in double-double. R is exact up to its one division: a component
/// of a body's axis that vanishes is 0, and a tiny one has all its digits. A float64 component would have the rounding
/// of the largest one, which acts as a torque on a body that stands upright.
std::array<math::DD, 3> see_from_body(const Quat& q_WB, const Vector3d& v_W);

/// p q, of which each component is the rounded exact one: one that vanishes is 0, and a tiny one has all its digits.
Quat multiply_exactly(const Quat& p, const Quat& q);

}  // namespace polhode
