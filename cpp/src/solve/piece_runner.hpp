#pragma once

#include <functional>

#include "solve/pieces.hpp"

namespace polhode {

/// How one piece is run. `scene` has the torques that act there, unwindowed, and starts where the last piece ended.
using RunPiece = std::function<Motion(const Scene& scene, const Piece& piece, const SolveOptions& options)>;

/// All pieces one after another, joined: samples, events and dense output are those of one motion, `error` is the
/// largest bound of a closed form. `perturb_joins`: where one piece ends and the next begins the state is changed by a
/// few units of rounding, for the run that a certificate compares with.
Motion run_pieces(const Scene& scene, const Pieces& pieces, const SolveOptions& options, const RunPiece& run,
                  bool perturb_joins = false);

}  // namespace polhode
