#pragma once

#include "polhode/scene/scene.hpp"

namespace polhode {

/// Refuses a torque that is no number at the start, and claims of custom torques that are not true.
/// @throws InvalidInput
void check_torques(const Scene& scene);

/// Calls each custom torque that claims not to see time, attitude or rates a few times, with only that changed: near
/// the start and over the first part of the span. @throws InvalidInput, naming the claim, when its torque changes: a
/// plan built on it would be wrong. What the function throws comes through.
void require_true_claims(const Scene& scene);

}  // namespace polhode
