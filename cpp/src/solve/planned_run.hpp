#pragma once

#include "solve/decision.hpp"

namespace polhode {

/// One run of all pieces of a decision, each by its own plan. `scene` is the decision's or one perturbed or shortened;
/// it is cut again, and its pieces take the plans in the same order from the start.
/// @param rtol  of the plan's method; each piece scales it
Motion run_planned(const Decision& decision, const Scene& scene, const SolveOptions& options, double rtol,
                   bool perturb_joins);

/// The answer by closed forms alone. A second, perturbed run measures what rounding at the joins does to it.
Motion solve_exact_pieces(const Decision& decision, const SolveOptions& options);

}  // namespace polhode
