#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "polhode/inertia/mesh.hpp"

namespace polhode::inertia {

/// Work on so many faces takes about a millisecond.
inline constexpr std::size_t faces_between_checks = 32768;

/// Throws InvalidInput, with the face, for an index that names no vertex, and for a mesh without faces.
void require_indices(const Mesh& mesh);

/// Throws InvalidInput, with the vertex, when a vertex that a face uses is not finite.
void require_finite_vertices(const Mesh& mesh);

/// The three vertices of each face, for any index type of the caller.
class Corners {
 public:
  explicit Corners(const Mesh& mesh);

  const std::uint32_t* operator[](std::size_t face) const { return first_ + 3 * face; }

  /// Replaces each vertex by the first vertex at exactly the same place.
  void merge(const Mesh& mesh);

 private:
  std::vector<std::uint32_t> own_;
  const std::uint32_t* first_;
};

}  // namespace polhode::inertia
