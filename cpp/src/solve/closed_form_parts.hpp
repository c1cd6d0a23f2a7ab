#pragma once

#include <optional>

#include "polhode/scene/scene.hpp"

// The parts of a scene from which its closed form is made.
namespace polhode {

/// The gravity of a scene in which it is the only torque; rotors may turn beside it.
const torques::Gravity* find_only_gravity(const Scene& scene);

/// The symmetry axis of HeavyTop, which requires two moments equal bit for bit. A full tensor has none, because its
/// moments are rounded.
std::optional<int> find_top_axis(const Scene& scene, const Vector3d& arm);

/// True if free rotors take their axial moments from the inertia.
bool has_carrier(const Scene& scene);

/// True if a vector has no component beside that along one axis.
bool is_along(const Vector3d& v, int axis);

}  // namespace polhode
