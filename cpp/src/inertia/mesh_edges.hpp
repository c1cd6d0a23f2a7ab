#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "inertia/mesh_surfaces.hpp"

// Every edge of a closed, oriented surface lies between two faces, which pass it in opposite directions.
namespace polhode::inertia {

/// The number of edges with a fault, and the first faces that have it.
class Fault {
 public:
  void add(std::uint32_t face, std::uint32_t another);
  std::size_t count() const { return count_; }
  std::string text(const char* what) const;

 private:
  void note(std::uint32_t face);

  std::size_t count_ = 0, kept_ = 0;
  std::array<std::uint32_t, 3> faces_{};
};

/// An edge with a fault, and how many more faces pass it from `low` to `high` than back.
struct FaultyEdge {
  std::uint32_t low, high;
  int net;
};

struct Faults {
  Fault open, reversed, crowded;
  std::size_t degenerate = 0;
  std::vector<FaultyEdge> edges;

  std::size_t count() const { return open.count() + reversed.count() + crowded.count(); }
  std::vector<std::uint32_t> vertices() const;  ///< the ends of the edges, ascending
};

/// Sorts the sides of the faces by their lower vertex (counting sort), then by the other vertex. Joins the faces of
/// each faultless edge.
Faults classify_edges(const Corners& corners, const Mesh& mesh, Surfaces& surfaces);

}  // namespace polhode::inertia
