#pragma once

#include <vector>

#include "derivative/column_terms.hpp"
#include "polhode/scene/parameter.hpp"
#include "solve/ground/pieces.hpp"

// The columns of a body that changes: by its start, and by numbers of torques.
namespace polhode {

/// Refuses a scene with rotors or a damper, and other parameters.
void require_fixed_body(const Scene& scene, const std::vector<SceneParameter>& parameters);

/// Puts the torque that stands for one of the scene in a piece, and the number of its input there, into a cause.
void find_scaled(const Scene& scene, const Piece& piece, std::size_t number, ColumnCause& cause);

}  // namespace polhode
