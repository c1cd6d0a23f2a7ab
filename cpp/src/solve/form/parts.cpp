#include "solve/form/parts.hpp"

#include <algorithm>

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

bool only_damps(const Scene& scene) {
  return std::all_of(scene.torques().begin(), scene.torques().end(), [](const AnyTorque& torque) {
    return traits(torque).vanishes || std::holds_alternative<torques::Damping>(torque) ||
           std::holds_alternative<torques::AngularDamping>(torque);
  });
}

}  // namespace polhode

namespace polhode::form {

std::string list_torques(const Scene& scene, const Facts& facts) {
  std::string names;
  for (const AnyTorque& torque : scene.torques()) {
    if (traits(torque).vanishes) continue;
    if (!names.empty()) names += " and ";
    names += torque_name(torque);
  }
  if (facts.torques.rotors) names += names.empty() ? "rotors" : " and rotors";
  return names + (facts.torques.acting == 1 && !facts.torques.rotors ? " acts" : " act");
}

std::string to_percent(double part) {
  char text[32];
  std::snprintf(text, sizeof text, part < 1e-3 ? "%.0e" : "%.2g %%", part < 1e-3 ? part : 100 * part);
  return text;
}

Refusal refuse_torques(const Scene& scene, const Facts& facts, Words words) {
  if (facts.is_free()) return holds();
  return refuse(words, [&] { return "not free: " + list_torques(scene, facts); });
}

}  // namespace polhode::form
