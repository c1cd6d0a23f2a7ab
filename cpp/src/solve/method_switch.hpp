#pragma once

#include "solve/decision.hpp"

namespace polhode {

/// Plans a strongly damped body after a low-accuracy pilot run has estimated its total rotation: the cheapest method, or
/// two pieces, Taylor's method followed by Radau's. The switch pays where the body spins fast at first, so that accuracy
/// bounds an explicit method's steps, and slowly later, where stability does.
/// @return false, and changes nothing, where damping is not stiff, the method is not free, or the pilot run would cost
///         more than it can save
bool plan_damped(Decision& decision, const SolveOptions& options);

}  // namespace polhode
