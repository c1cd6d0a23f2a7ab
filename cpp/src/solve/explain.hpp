#pragma once

#include "solve/decision.hpp"

namespace polhode {

/// Puts a decision into words, with every candidate evaluated.
PlanReport explain(const Decision& decision, const SolveOptions& options);

}  // namespace polhode
