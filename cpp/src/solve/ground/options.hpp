#pragma once

#include "polhode/method/run_options.hpp"
#include "polhode/ode/method_record.hpp"
#include "polhode/ode/problem.hpp"
#include "polhode/solve/solve.hpp"

namespace polhode {

/// @throws InvalidInput for options that contradict each other, have no effect, or are missing
void check_options(const Scene& scene, const SolveOptions& options);

/// Refuses a torque that is not finite at the start. A torque that becomes infinite later ends the run there.
/// @throws InvalidInput
void require_finite_start(const Scene& scene);

/// True if a torque of the user's own acts, which only the user knows the cost of.
bool calls_custom(const Scene& scene);

/// The run is controlled by rtol, atol or step, and its error is not estimated.
inline bool is_by_tolerance(const SolveOptions& options) { return options.rtol || options.atol || options.step; }

/// The options name neither a method nor a formulation.
inline bool method_is_free(const SolveOptions& options) {
  return !options.method && options.formulation == Formulation::euler;
}

/// The tolerances of a step, from checked options.
struct StepTolerances {
  ode::Tolerances tolerances;
  double asked;    ///< the requested relative tolerance
  bool raised;     ///< to the smallest tolerance of the method
};
/// @throws InvalidInput if the method needs a step and none is given
StepTolerances choose_tolerances(const ode::MethodRecord& record, const SolveOptions& options);

/// Sets the requested tolerance and the message of a run by tolerances.
void describe_end(const StepTolerances& step, Motion& motion);

/// The options of one run. `options` must outlive the result, because its events are not copied.
RunOptions to_run_options(const SolveOptions& options, const ode::Tolerances& tolerances,
                          ode::ErrorTrace* trace = nullptr);

}  // namespace polhode
