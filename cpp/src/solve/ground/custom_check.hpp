#pragma once

#include "polhode/scene/scene.hpp"

namespace polhode {

/// Refuses a torque that is not finite at the start, and a false claim of a custom torque.
/// @throws InvalidInput
void check_torques(const Scene& scene);

/// Checks custom torques that claim not to depend on time, attitude or rates. Calls each a few times, near the start
/// and over the first part of the span, with only that argument changed.
/// @throws InvalidInput, naming the claim, if the torque changes. Exceptions of the function pass through.
void require_true_claims(const Scene& scene);

}  // namespace polhode
