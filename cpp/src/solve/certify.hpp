#pragma once

#include "solve/decision.hpp"

namespace polhode {

/// Integrates a scene by the decision's method and bounds the error of every sample. The error is "expected" if no
/// certificate is requested, and a "limit" if float64 cannot reach the accuracy.
///
/// A method with BodyMethod::carries_error certifies its own run (certify_carried.hpp). For the others the certificate
/// is a pair of runs (certify_pair.hpp). If the error exceeds the accuracy, the run is repeated with a smaller
/// tolerance, reduced by the ratio of the two.
Motion certify(const Decision& decision, const SolveOptions& options);

}  // namespace polhode
