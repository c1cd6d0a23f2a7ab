#pragma once

#include "solve/decision.hpp"

namespace polhode {

/// Plans a strongly damped body after a low-accuracy pilot run has estimated its total rotation. The plan is the
/// cheapest method, or two pieces: Taylor's method followed by Radau's. The switch pays if the body first spins fast,
/// so that accuracy limits explicit steps, and later slowly, so that stability limits them.
/// @return false, without a change, if damping is not stiff, if the method is prescribed, or if the pilot run would
///         cost more than it can save
bool plan_damped(Decision& decision, const SolveOptions& options);

}  // namespace polhode
