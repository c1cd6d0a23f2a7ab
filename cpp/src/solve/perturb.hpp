#pragma once

#include "polhode/scene/scene.hpp"

namespace polhode {

/// The scene with every input that is not zero moved by two units in the last place, up or down by a fixed rule: what
/// it does differently is what rounding of the inputs does. Custom torques stay as they are, and so do windows' ends
/// at the start and outside the span.
Scene perturb(const Scene& scene);

/// A state moved by so many units of rounding, up or down by a rule that `seed` chooses.
State shake(const State& state, double units, int seed);

}  // namespace polhode
