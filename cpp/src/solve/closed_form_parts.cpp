#include "solve/closed_form_parts.hpp"

namespace polhode {

const torques::Gravity* find_only_gravity(const Scene& scene) {
  const torques::Gravity* found = nullptr;
  for (const AnyTorque& torque : scene.torques()) {
    if (traits(torque).vanishes) continue;
    const auto* gravity = std::get_if<torques::Gravity>(&torque);
    if (gravity == nullptr || found != nullptr) return nullptr;
    found = gravity;
  }
  return found;
}

std::optional<int> find_top_axis(const Scene& scene, const Vector3d& arm) {
  const Matrix3d& I = scene.inertia_B().matrix();
  if (!scene.inertia_B().is_diagonal()) return std::nullopt;
  for (const int axis : {2, 0, 1}) {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    if (I(a, a) != I(b, b)) continue;
    if (is_along(arm, axis)) return axis;
    return std::nullopt;   // HeavyTop takes the first equal pair
  }
  return std::nullopt;
}

bool has_carrier(const Scene& scene) { return scene.inertia_B().matrix() != scene.given_inertia_B().matrix(); }

bool is_along(const Vector3d& v, int axis) { return v[(axis + 1) % 3] == 0.0 && v[(axis + 2) % 3] == 0.0; }

}  // namespace polhode
