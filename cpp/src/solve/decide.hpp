#pragma once

#include "solve/decision.hpp"

namespace polhode {

/// Chooses the model, the method and the pieces. `options` have been checked.
/// @throws InvalidInput for a method that does not take the scene
Decision decide(const Scene& scene, const SolveOptions& options);

}  // namespace polhode
