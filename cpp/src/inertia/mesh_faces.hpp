#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "polhode/inertia/mesh.hpp"

namespace polhode::inertia {

/// Throws InvalidInput, with the face, for an index that names no vertex, and for a mesh without faces.
void require_indices(const Mesh& mesh);

/// Throws InvalidInput, with the vertex, when one of those that the faces use is not finite.
void require_finite_vertices(const Mesh& mesh);

/// Three vertices of each face, whatever the caller's type of index.
class Corners {
 public:
  explicit Corners(const Mesh& mesh);

  const std::uint32_t* operator[](std::size_t face) const { return first_ + 3 * face; }

  /// The same faces with vertices at exactly one place taken as one, the first of them.
  void merge(const Mesh& mesh);

 private:
  std::vector<std::uint32_t> own_;
  const std::uint32_t* first_;
};

}  // namespace polhode::inertia
