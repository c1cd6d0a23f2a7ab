#pragma once

#include "solve/decision.hpp"

namespace polhode {

/// Runs all pieces of a decision, each by its own plan. `scene` is the scene of the decision, or that scene with
/// perturbed inputs or fewer times. It is cut again, and its pieces take the plans in the same order.
/// @param rtol   the tolerance of the plan's method, which each piece scales
/// @param trace  if given, the error of all pieces, which must have closed forms or methods that carry their error
Motion run_planned(const Decision& decision, const Scene& scene, const SolveOptions& options, double rtol,
                   bool perturb_joins, ode::ErrorTrace* trace = nullptr);

/// The plan of a run: that of the decision, and for each piece what ran in its place.
Plan describe_run(const Decision& decision, const Motion& motion);

/// Evaluates pieces that all have closed forms. A second, perturbed run measures the effect of rounding at the joins.
Motion solve_exact_pieces(const Decision& decision, const SolveOptions& options);

}  // namespace polhode
