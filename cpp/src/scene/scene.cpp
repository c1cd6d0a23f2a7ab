#include "polhode/scene/scene.hpp"

#include <cmath>

#include "polhode/core/error.hpp"

namespace polhode {

Scene::Scene(SceneParts parts) : parts_(std::move(parts)) {
  const Vector3d& moments = parts_.inertia_B.moments();
  if (!(moments.minCoeff() > 0.0)) {
    throw InvalidInput("scene.inertia", "a tensor with three positive principal moments",
                       "a least moment of " + to_text(moments.minCoeff()),
                       "a rod or a point has no spin about its axis: its rate there is not determined");
  }
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(parts_.omega[i])) throw InvalidInput("scene.omega", "finite", to_text(parts_.omega[i]));
  }
  parts_.attitude = make_attitude(parts_.attitude);
  if (!std::isfinite(parts_.t0)) throw InvalidInput("scene.t0", "finite", to_text(parts_.t0));
  if (parts_.times.empty()) {
    throw InvalidInput("scene.times", "at least one time", "none", "say when the answer is wanted");
  }
  for (std::size_t i = 0; i < parts_.times.size(); ++i) {
    if (!std::isfinite(parts_.times[i])) {
      throw InvalidInput("scene.times", "finite", to_text(parts_.times[i]) + " at index " + std::to_string(i));
    }
  }
  if (!parts_.want.omega && !parts_.want.attitude) {
    throw InvalidInput("scene.want", "omega, attitude or both", "neither");
  }
  torque_sum_ = summarize(parts_.torques);
}

}  // namespace polhode
