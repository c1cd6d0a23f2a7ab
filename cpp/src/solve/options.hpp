#pragma once

#include "polhode/method/run_options.hpp"
#include "polhode/ode/method_record.hpp"
#include "polhode/ode/problem.hpp"
#include "polhode/solve/solve.hpp"

namespace polhode {

/// @throws InvalidInput for options that contradict each other, have no effect, or are missing
void check_options(const Scene& scene, const SolveOptions& options);

/// A torque that is no number at the start is a mistake; one that becomes none on the way ends the run there.
/// @throws InvalidInput
void require_finite_start(const Scene& scene);

/// The run is controlled by rtol, atol or step, and its error is not estimated.
inline bool is_by_tolerance(const SolveOptions& options) { return options.rtol || options.atol || options.step; }

/// Neither method nor formulation is asked for.
inline bool method_is_free(const SolveOptions& options) {
  return !options.method && options.formulation == Formulation::euler;
}

/// The tolerances of a step: what remains of the options once they have been checked.
struct StepTolerances {
  ode::Tolerances tolerances;
  double asked;    ///< the relative tolerance that was asked for
  bool raised;     ///< to the least that the method can serve
};
/// @throws InvalidInput where the method asks for a step that is not given
StepTolerances choose_tolerances(const ode::MethodRecord& record, const SolveOptions& options);

/// Sets what was asked for, and the message of a run by tolerances.
void describe_end(const StepTolerances& step, Motion& motion);

/// The options of one run. `options` must outlive it: its events are not copied.
RunOptions to_run_options(const SolveOptions& options, const ode::Tolerances& tolerances,
                          ode::ErrorTrace* trace = nullptr);

}  // namespace polhode
