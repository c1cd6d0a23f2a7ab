#pragma once

#include <cstdint>
#include <vector>

#include "inertia/mesh_edges.hpp"

// Vertices that are meant to be one, and are not to the last bit.
namespace polhode::inertia {

/// For each vertex of an ascending list the first of its group. Two vertices nearer than `distance` are in one group,
/// and so are chains of them: the groups do not depend on the order.
struct Weld {
  std::vector<std::uint32_t> first;
  std::size_t given_up = 0;  ///< vertices that are not the first of their group
  double moved = 0;          ///< the largest distance from a vertex to its first
};

/// On a grid of cells in which all vertices are near each other: time in proportion to the vertices.
Weld weld_vertices(const double* coordinates, const std::vector<std::uint32_t>& vertices, double distance);

/// The least part of `size`, from `least` to 0.01, within which the vertices of the faulty edges must be one for all of
/// them to close; 0 for none. It is rounded up to two digits.
double find_closing_weld(const Corners& corners, const Mesh& mesh, const std::vector<std::uint32_t>& at_faults,
                         double size, double least);

}  // namespace polhode::inertia
