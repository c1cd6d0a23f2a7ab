#pragma once

#include "solve/decision.hpp"

namespace polhode {

/// The words for a decision whose span is cut at windows' ends.
PlanReport explain_pieces(const Decision& decision, const SolveOptions& options);

}  // namespace polhode
