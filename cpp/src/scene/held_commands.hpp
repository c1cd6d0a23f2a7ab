#pragma once

#include <string>

#include "polhode/scene/scene.hpp"

namespace polhode {

/// @throws InvalidInput if a torque has a state of this name
void require_free_name(const SceneParts& parts, const std::string& name);

/// Gives the commands of controllers states, and adds their torques, unless they have them.
void add_controllers(SceneParts& parts);

}  // namespace polhode
