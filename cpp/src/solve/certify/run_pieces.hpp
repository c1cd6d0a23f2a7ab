#pragma once

#include "polhode/ode/tracked_taylor.hpp"
#include "solve/ground/decision.hpp"

// A chain of pieces: each runs by its own plan, and errors are carried from one to the next.
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

/// Carries the errors of a trace through a piece that a closed form evaluates, to the last of its times. They are the
/// differences of closed forms from perturbed starts. The trace's vectors are errors of (omega, 0, attitude). A pendulum
/// has errors in its plane only, because its motion is in the plane exactly.
/// Returns false, and changes nothing, where a perturbed start has no closed form.
/// @param form        the piece's closed form
/// @param form_error  bound of the closed form's own error
bool carry_error(const Scene& piece, const ClosedForm& form, double form_error, ode::ErrorTrace& trace);

}  // namespace polhode
