#pragma once

#include "polhode/ode/method_record.hpp"
#include "polhode/ode/problem.hpp"
#include "polhode/solve/solve.hpp"

namespace polhode {

/// The tolerances of a step: what remains of the options once they have been checked.
struct CheckedOptions {
  ode::Tolerances tolerances;
  double asked;    ///< the relative tolerance that was asked for
  bool raised;     ///< to the least that the method can serve
};
CheckedOptions choose_tolerances(const ode::MethodRecord& record, const SolveOptions& options);

/// What was asked for, and the message of a run by tolerances.
void describe_end(const CheckedOptions& checked, Motion& motion);

/// A torque that is no number at the start is a mistake; one that becomes none on the way ends the run there.
void require_finite_start(const Scene& scene);

}  // namespace polhode
