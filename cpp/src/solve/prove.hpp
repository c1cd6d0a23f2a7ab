#pragma once

#include "polhode/solve/solve.hpp"

namespace polhode {

/// Solves a scene with bounds that are theorems. Samples beyond the reach of the proof are those of a plain run.
/// `options` have been checked, and ask for a proof.
Motion prove(const Scene& scene, const SolveOptions& options);

}  // namespace polhode
