#pragma once

#include "solve/decision.hpp"

namespace polhode {

/// Describes a decision in words, and evaluates every candidate.
PlanReport explain(const Decision& decision, const SolveOptions& options);

}  // namespace polhode
