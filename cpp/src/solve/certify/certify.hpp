#pragma once

#include "solve/ground/decision.hpp"

// How a decision is carried out, and its error bounded.
namespace polhode {

/// Carries out a decision with the options that it was made for.
Motion execute(const Decision& decision, const SolveOptions& options);

/// Integrates a scene by the decision's method and bounds the error of every sample. The error is "expected" if no
/// certificate is requested, and a "limit" if float64 cannot reach the accuracy.
///
/// A method with BodyMethod::carries_error certifies its own run (run_carried). For the others the certificate
/// is a pair of runs (certify/pair.hpp). If the error exceeds the accuracy, the run is repeated with a smaller
/// tolerance, reduced by the ratio of the two.
Motion certify(const Decision& decision, const SolveOptions& options);

/// Solves a scene with bounds that are theorems. Samples beyond the reach of the proof are those of a plain run.
/// `options` have been checked, and ask for a proof.
Motion prove(const Decision& decision, const SolveOptions& options);

}  // namespace polhode
