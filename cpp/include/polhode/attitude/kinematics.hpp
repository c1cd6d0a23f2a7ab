#pragma once

#include <string_view>

#include "polhode/attitude/euler.hpp"

namespace polhode {

/// w_B [rad/s] of Euler angles [rad] and their rates [rad/s], both in the order of the sequence's letters.
Vector3d body_rates(const EulerSequence& sequence, const Vector3d& angles, const Vector3d& angle_rates);

/// The angles' rates of w_B; the inverse of body_rates. Where the middle angle is the double nearest to a pole the
/// outer axes are one and no rates give a general w_B: InvalidInput, with `where` as the name in the message.
Vector3d euler_rates(const EulerSequence& sequence, const Vector3d& angles, const Vector3d& w_B,
                     std::string_view where = "angles");

}  // namespace polhode
