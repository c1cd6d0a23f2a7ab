#pragma once

#include "polhode/solve/plan.hpp"
#include "solve/pieces.hpp"
#include "solve/run.hpp"

namespace polhode {

/// What a plan of pieces rests on; `turns` in the facts are those whose forecast is that of the whole chain.
struct PiecesPlan {
  Plan plan;
  Facts facts;
  double turns = 0.0;   ///< of all pieces together, as a person counts them
};

/// What fits each piece: its closed form where one holds, else the cheapest method; where the body is when a piece
/// begins is told by a loose run of the whole chain.
/// @throws InvalidInput for method 'exact' where a piece has no closed form, naming the piece
PiecesPlan plan_pieces(const Scene& scene, const Pieces& pieces, const SolveOptions& options);

/// The same in words.
PlanReport explain_pieces(const Scene& scene, const Pieces& pieces, const SolveOptions& options);

/// One run of the chain by its plan, the steps at this tolerance.
Motion run_by_plan(const Scene& scene, const RunOptions& options, const Plan& plan, bool shaken);

/// The answer by closed forms alone. What rounding at the joints does to it is told by a second, moved run.
Motion solve_exact_pieces(const Scene& scene, const SolveOptions& options, const Plan& plan);

}  // namespace polhode
