#pragma once

#include <vector>

#include "inertia/mesh_edges.hpp"

namespace polhode::inertia {

/// The loops of edges that more faces pass one way than the other, the largest first. `errors` is set from them.
/// `slack` is a volume: a bound of what the weld's moves can sweep.
std::vector<MeshHole> measure_holes(const std::vector<FaultyEdge>& edges, const Mesh& mesh, double slack,
                                    MeshErrors& errors);

}  // namespace polhode::inertia
