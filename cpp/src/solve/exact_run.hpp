#pragma once

#include <optional>

#include "polhode/solve/solve.hpp"

namespace polhode {

/// The answer of a closed form, where one holds and the options leave the choice: an accuracy or nothing at all, Euler's
/// equations, and no method but "exact". @throws InvalidInput when "exact" is asked for where it cannot be had.
std::optional<Motion> solve_exactly(const Scene& scene, const SolveOptions& options);

}  // namespace polhode
