#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "inertia/mesh_faces.hpp"

namespace polhode::inertia {

inline bool is_degenerate(const std::uint32_t* v) { return v[0] == v[1] || v[1] == v[2] || v[2] == v[0]; }

/// Union-find over faces that share an edge. A surface is known by its root, its first face.
class Surfaces {
 public:
  explicit Surfaces(std::size_t faces) : parent_(faces) { std::iota(parent_.begin(), parent_.end(), 0u); }

  std::uint32_t root(std::uint32_t face) {
    while (parent_[face] != face) face = parent_[face] = parent_[parent_[face]];
    return face;
  }
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a), b = root(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);  // the root is the first face
  }

 private:
  std::vector<std::uint32_t> parent_;
};

/// A connected part of a mesh: faces that share edges.
struct Surface {
  std::uint32_t first_face = 0;
  std::size_t faces = 0;
  double volume = 0;    ///< times 6
  double rounding = 0;  ///< bound of the rounding error of `volume`
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;

  bool is_wound(double sign) const { return sign * volume > rounding; }
  bool holds(const Vector3d& p) const { return (low.array() <= p.array()).all() && (p.array() <= high.array()).all(); }
};

std::vector<Surface> measure(const Corners& corners, const Mesh& mesh, Surfaces& roots);

/// Finds which surfaces lie inside others, by the winding number of the others about a point of each. Counts cavities
/// that lie in no solid, and outward surfaces inside a solid, whose volume counts twice.
/// `report.inside_out` says which winding is outward.
void check_nesting(const std::vector<Surface>& surfaces, const Corners& corners, const Mesh& mesh, Surfaces& roots,
                   MeshReport& report);

}  // namespace polhode::inertia
