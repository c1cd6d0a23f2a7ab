#pragma once

#include "polhode/solve/closed_form.hpp"
#include "polhode/solve/solve.hpp"

namespace polhode {

/// The answer of a closed form, with the events found on it; its plan has bounded the error.
Motion run_closed_form(const Scene& scene, const Facts& facts, const SolveOptions& options, ClosedForm form,
                       const Plan& plan);

}  // namespace polhode
