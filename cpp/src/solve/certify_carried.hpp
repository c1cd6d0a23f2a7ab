#pragma once

#include "solve/attempt.hpp"

namespace polhode {

/// A run that propagates its own error. Each step adds its truncation and rounding errors, and the linearised motion
/// propagates their sum to the next step.
/// @param safety  the factor between the propagated error and the claimed error
/// @param all_terms  the error gets all terms of the series
/// @param most    the run is abandoned when its error exceeds this multiple of the accuracy
/// @return an attempt without motion if the run was abandoned; `given_up` is then the time from the start [s]
Attempt run_carried(CountedRuns& runs, double rtol, double safety, bool all_terms, double most, double& given_up);

}  // namespace polhode
