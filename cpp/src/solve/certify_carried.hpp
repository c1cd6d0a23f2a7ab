#pragma once

#include "solve/attempt.hpp"

namespace polhode {

/// A run that carries its error along: each step adds what its truncated series loses and what rounding takes, and the
/// linearised motion carries the sum to the next step.
/// @param safety  the factor between what was carried and what is claimed
/// @param most    the run is given up where its error exceeds this multiple of the accuracy
/// @return an attempt without motion where the run was given up; `given_up` is then how far it came [s]
Attempt run_carried(CountedRuns& runs, double rtol, double safety, double most, double& given_up);

}  // namespace polhode
