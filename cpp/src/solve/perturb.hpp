#pragma once

#include "polhode/scene/scene.hpp"

namespace polhode {

/// The scene with every input that is not zero moved by two units in the last place, up or down by a fixed rule: what
/// it does differently is what rounding of the inputs does. Custom torques stay as they are.
Scene perturb(const Scene& scene);

}  // namespace polhode
