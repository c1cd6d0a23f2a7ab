#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "polhode/inertia/mesh.hpp"

namespace polhode::inertia {

/// Work on so many faces takes about a millisecond.
inline constexpr std::size_t faces_between_checks = 32768;

inline std::uint64_t mixed(std::uint64_t h) {  // the finaliser of MurmurHash3
  h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdULL;
  h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53ULL;
  return h ^ (h >> 33);
}

/// Throws InvalidInput, with the face, for an index that names no vertex, and for a mesh without faces.
void require_indices(const Mesh& mesh);

/// Throws InvalidInput, with the vertex, when a vertex that a face uses is not finite.
void require_finite_vertices(const Mesh& mesh);

/// The three vertices of each face, for any index type of the caller.
class Corners {
 public:
  explicit Corners(const Mesh& mesh);
  Corners(Corners&&) = default;
  Corners& operator=(Corners&&) = default;

  const std::uint32_t* operator[](std::size_t face) const { return first_ + 3 * face; }

  /// Replaces each vertex by the first vertex at exactly the same place.
  void merge(const Mesh& mesh);

  /// The same faces with each vertex v replaced by by[v].
  Corners replaced(const std::vector<std::uint32_t>& by, std::size_t faces) const;

  std::vector<std::int64_t> numbers(std::size_t faces) const { return {first_, first_ + 3 * faces}; }

 private:
  Corners() = default;

  std::vector<std::uint32_t> own_;
  const std::uint32_t* first_ = nullptr;
};

}  // namespace polhode::inertia
