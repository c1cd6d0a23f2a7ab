#pragma once

#include "solve/decision.hpp"

namespace polhode {

/// Integrates a scene by the decision's method and bounds the error of every sample. The error is "expected" where no
/// certificate is wanted, and a "limit" where float64 gives no more.
///
/// A method that carries its error along (BodyMethod::carries_error) certifies its own run: certify_carried.hpp. For the
/// others the certificate is a pair of runs: certify_pair.hpp. A run whose error is above the accuracy is made again,
/// tighter by as much as was missing.
Motion certify(const Decision& decision, const SolveOptions& options);

}  // namespace polhode
