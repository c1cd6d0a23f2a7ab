#pragma once

#include <functional>

#include "solve/ground/pieces.hpp"

namespace polhode {

/// Runs one piece. `scene` has the torques of the piece, without windows, and starts where the last piece ended.
using RunPiece = std::function<Motion(const Scene& scene, const Piece& piece, const SolveOptions& options)>;

/// Runs all pieces one after another and joins their samples, events and dense output to one motion. Its `error` is the
/// largest bound of a closed form.
/// @param perturb_joins  change the state between two pieces by a few units of rounding, for the comparison run of a
///                       certificate
Motion run_pieces(const Scene& scene, const Pieces& pieces, const SolveOptions& options, const RunPiece& run,
                  bool perturb_joins = false);

}  // namespace polhode
