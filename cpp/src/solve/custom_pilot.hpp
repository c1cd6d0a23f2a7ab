#pragma once

#include "solve/decision.hpp"

namespace polhode {

/// The time of one call of each of the user's own torques, at the start, together [s]. Plans show it, and no choice
/// depends on it.
double measure_call_seconds(const Scene& scene);

/// Runs a scene with a torque of the user's own at a low accuracy, and completes the facts of the decision: turns,
/// effort, decay and stiffness. Nothing but such a run can tell what an unknown function does. A run that ends early
/// is extrapolated.
void pilot_custom(Decision& decision, const SolveOptions& options);

}  // namespace polhode
