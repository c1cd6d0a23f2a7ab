#pragma once

#include "polhode/ode/tracked_taylor.hpp"
#include "polhode/solve/closed_form.hpp"

namespace polhode {

/// Carries the errors of a trace through a piece that a closed form evaluates, to the last of its times. They are the
/// differences of closed forms from perturbed starts. The trace's vectors are errors of (omega, 0, attitude). A pendulum
/// has errors in its plane only, because its motion is in the plane exactly.
/// Returns false, and changes nothing, where a perturbed start has no closed form.
/// @param form        the piece's closed form
/// @param form_error  bound of the closed form's own error
bool carry_through(const Scene& piece, const ClosedForm& form, double form_error, ode::ErrorTrace& trace);

}  // namespace polhode
