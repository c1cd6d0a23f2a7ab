#pragma once

#include "solve/decision.hpp"

namespace polhode {

/// Describes a decision whose span is cut at the ends of windows.
PlanReport explain_pieces(const Decision& decision, const SolveOptions& options);

}  // namespace polhode
