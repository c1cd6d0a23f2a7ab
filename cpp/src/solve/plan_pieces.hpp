#pragma once

#include "solve/decision.hpp"

namespace polhode {

/// Plans each piece of a decision whose span is cut: its closed form if one holds, else the cheapest method. A pilot
/// run of all pieces estimates the start state of each.
/// @throws InvalidInput for method 'exact' if a piece has no closed form, naming the piece
void plan_pieces(Decision& decision, const SolveOptions& options);

}  // namespace polhode
