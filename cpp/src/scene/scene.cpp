#include "polhode/scene/scene.hpp"

#include <cmath>

#include "polhode/core/error.hpp"
#include "polhode/core/float_state.hpp"

namespace polhode {

Scene::Scene(SceneParts parts) {
  const Vector3d& moments = parts.inertia_B.moments();
  if (!(moments.minCoeff() > 0.0)) {
    throw InvalidInput("scene.inertia", "a tensor with three positive principal moments",
                       "a least moment of " + to_text(moments.minCoeff()),
                       "a rod or a point has a zero moment, so its rate about that axis is undefined");
  }
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(parts.omega[i])) throw InvalidInput("scene.omega", "finite", to_text(parts.omega[i]));
    require_kept(parts.omega[i], "scene.omega");
  }
  parts.attitude = make_attitude(parts.attitude);
  if (!std::isfinite(parts.t0)) throw InvalidInput("scene.t0", "finite", to_text(parts.t0));
  if (parts.times.empty()) {
    throw InvalidInput("scene.times", "at least one time", "none", "give the times of the samples");
  }
  for (std::size_t i = 0; i < parts.times.size(); ++i) {
    if (!std::isfinite(parts.times[i])) {
      throw InvalidInput("scene.times", "finite", to_text(parts.times[i]) + " at index " + std::to_string(i));
    }
  }
  if (!parts.want.omega && !parts.want.attitude) {
    throw InvalidInput("scene.want", "omega, attitude or both", "neither");
  }
  torque_sum_ = summarize(parts.torques);
  parts_ = std::make_shared<const SceneParts>(std::move(parts));
}

}  // namespace polhode
