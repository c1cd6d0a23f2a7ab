#pragma once

#include "polhode/solve/closed_form.hpp"
#include "polhode/solve/solve.hpp"

namespace polhode {

/// Evaluates a closed form and finds events on it. `plan.predicted_error` is the bound of its error.
Motion run_closed_form(const Scene& scene, const Facts& facts, const SolveOptions& options, std::shared_ptr<const ClosedForm> form,
                       const Plan& plan);

}  // namespace polhode
