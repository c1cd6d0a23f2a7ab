#pragma once

#include "polhode/solve/facts.hpp"
#include "polhode/solve/solve.hpp"

namespace polhode {

/// Steps a scene by the plan's method and bounds the error of every sample, or says "expected" where no certificate is
/// wanted, or "limit" where float64 gives no more.
///
/// A method that carries its error along (BodyMethod::carries_error) certifies its own run. For the others the
/// certificate is a pair of runs: one at a tolerance t with every input moved by two units in the last place, one at
/// t / 5 with the inputs as they are, which is returned. Their difference is the error of the coarser run and what
/// rounding of the inputs does to it; where it is within the accuracy, the finer run is five times within. When it is
/// not, both are made again, tighter by as much as was missing.
Motion solve_certified(const Scene& scene, const Facts& facts, const SolveOptions& options, const Plan& plan);

}  // namespace polhode
