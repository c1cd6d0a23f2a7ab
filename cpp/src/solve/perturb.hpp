#pragma once

#include "polhode/scene/scene.hpp"

namespace polhode {

/// The scene with every input that is not zero changed by two units in the last place, up or down by a fixed rule. What
/// it does differently is what rounding of the inputs does. Custom torques stay as they are, and so do windows' ends
/// at the start and outside the span.
Scene perturb(const Scene& scene);

/// A state changed by so many units of rounding, up or down by a rule that `seed` chooses.
State perturb_state(const State& state, double units, int seed);

}  // namespace polhode
