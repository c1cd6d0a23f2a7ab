#pragma once

#include "solve/ground/decision.hpp"

// How a scene is planned, and the plan in words.
namespace polhode {

/// Chooses the model, the method and the pieces. `options` have been checked.
/// @throws InvalidInput for a method that does not take the scene
Decision decide(const Scene& scene, const SolveOptions& options);

/// Plans each piece of a decision whose span is cut: its closed form if one holds, else the cheapest method. A pilot
/// run of all pieces estimates the start state of each.
/// @throws InvalidInput for method 'exact' if a piece has no closed form, naming the piece
void plan_pieces(Decision& decision, const SolveOptions& options);

/// Plans a strongly damped body after a low-accuracy pilot run has estimated its total rotation. The plan is the
/// cheapest method, or two pieces: Taylor's method followed by Radau's. The switch pays if the body first spins fast,
/// so that accuracy limits explicit steps, and later slowly, so that stability limits them.
/// @return false, without a change, if damping is not stiff, if the method is prescribed, or if the pilot run would
///         cost more than it can save
bool plan_stiff(Decision& decision, const SolveOptions& options);

/// The time of one call of each of the user's own torques, at the start, together [s]. Plans show it, and no choice
/// depends on it.
double measure_call_seconds(const Scene& scene);

/// Runs a scene with a torque of the user's own at a low accuracy, and completes the facts of the decision: turns,
/// effort, decay and stiffness. Nothing but such a run can tell what an unknown function does. A run that ends early
/// is extrapolated.
void pilot_custom(Decision& decision, const SolveOptions& options);

/// Describes a decision in words, and evaluates every candidate.
PlanReport explain(const Decision& decision, const SolveOptions& options);

/// Describes a decision whose span is cut at the ends of windows.
PlanReport explain_pieces(const Decision& decision, const SolveOptions& options);

}  // namespace polhode
