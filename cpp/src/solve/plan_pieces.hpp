#pragma once

#include "solve/decision.hpp"

namespace polhode {

/// Plans each piece of a decision whose span is cut: its closed form where one holds, else the cheapest method. A pilot
/// run of the whole chain estimates where the body is when a piece begins.
/// @throws InvalidInput for method 'exact' where a piece has no closed form, naming the piece
void plan_pieces(Decision& decision, const SolveOptions& options);

}  // namespace polhode
