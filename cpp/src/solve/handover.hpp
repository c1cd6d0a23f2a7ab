#pragma once

#include <optional>

#include "solve/planned_pieces.hpp"

namespace polhode {

/// The plan of a strongly damped body, after a loose run that tells how far it turns before it slows down: the cheapest
/// method with that known; or, where it spins fast at first and slowly later, so that accuracy bounds an explicit
/// method's steps at first and stability later, two pieces, Taylor's steps until it pays to hand the state to Radau's.
/// None where damping is not stiff, the method is not free, or the look would cost more than it can save.
std::optional<PiecesPlan> plan_damped(const Scene& scene, const Facts& facts, const SolveOptions& options);

}  // namespace polhode
