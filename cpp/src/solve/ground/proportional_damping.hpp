#pragma once

#include <optional>

#include "polhode/scene/scene.hpp"

namespace polhode {

/// The torque -c I omega, as one torque or as the sum of several.
struct ProportionalDamping {
  double rate = 0.0;     ///< c [1/s]
  bool rounded = false;  ///< the torque given differs from -c I omega by up to half a unit in the last place
};

/// c of a matrix whose every entry is the float64 rounding of c I_ij for one float64 c. No tolerance enters.
std::optional<ProportionalDamping> find_proportional(const Matrix3d& damping, const Matrix3d& inertia_B);

/// c of all acting torques of a scene together, if each of them is proportional to the angular momentum.
std::optional<ProportionalDamping> find_proportional_damping(const Scene& scene);

}  // namespace polhode
