#pragma once

#include "solve/decision.hpp"

namespace polhode {

/// Solves a scene with bounds that are theorems. Samples beyond the reach of the proof are those of a plain run.
/// `options` have been checked, and ask for a proof.
Motion prove(const Decision& decision, const SolveOptions& options);

}  // namespace polhode
