#pragma once

#include <string>
#include <vector>

#include "polhode/solve/plan.hpp"

namespace polhode::proof {

/// Refuses options and torques for which there is no proof.
/// @throws InvalidInput
void require_provable(const Scene& scene, const SolveOptions& options);

/// The plan of a proof, without its accuracy: Euler's equations, enclosed.
Plan make_plan(const Scene& scene);

/// What a proof does, in words.
std::vector<std::string> explain(const Scene& scene);

}  // namespace polhode::proof
