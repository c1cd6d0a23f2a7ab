#include "inertia/mesh_edges.hpp"

#include <algorithm>

#include "polhode/core/interrupt.hpp"

namespace polhode::inertia {
namespace {

/// The sides of one edge, from `begin` to `end`. The lower 32 bits hold the face, and the direction in the last bit.
void classify_edge(std::uint32_t low, const std::uint64_t* begin, const std::uint64_t* end, Faults& faults,
                   Surfaces& surfaces) {
  const auto face = [](std::uint64_t side) { return static_cast<std::uint32_t>(side & 0xffffffffu) >> 1; };
  const std::uint32_t first = face(begin[0]), second = face(end[-1]);
  if (end - begin == 2 && ((begin[0] ^ begin[1]) & 1) == 1) return surfaces.join(first, second);
  (end - begin == 1 ? faults.open : end - begin == 2 ? faults.reversed : faults.crowded).add(first, second);
  int net = 0;
  for (const std::uint64_t* side = begin; side != end; ++side) net += (*side & 1) == 1 ? 1 : -1;
  faults.edges.push_back({low, static_cast<std::uint32_t>(*begin >> 32), net});
}

}  // namespace

void Fault::add(std::uint32_t face, std::uint32_t another) {
  ++count_;
  note(face);
  note(another);
}

std::string Fault::text(const char* what) const {
  std::string out = std::to_string(count_);
  out += what;
  out += " (first faces ";
  for (std::size_t i = 0; i < kept_; ++i) {
    if (i > 0) out += ", ";
    out += std::to_string(faces_[i]);
  }
  return out + ")";
}

void Fault::note(std::uint32_t face) {
  for (std::size_t i = 0; i < kept_; ++i)
    if (faces_[i] == face) return;
  if (kept_ < faces_.size()) {
    faces_[kept_++] = face;
  } else if (face < faces_[kept_ - 1]) {
    faces_[kept_ - 1] = face;
  }
  std::sort(faces_.begin(), faces_.begin() + static_cast<std::ptrdiff_t>(kept_));
}

std::vector<std::uint32_t> Faults::vertices() const {
  std::vector<std::uint32_t> all;
  all.reserve(2 * edges.size());
  for (const FaultyEdge& edge : edges) all.insert(all.end(), {edge.low, edge.high});
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

Faults classify_edges(const Corners& corners, const Mesh& mesh, Surfaces& surfaces) {
  Faults faults;
  std::vector<std::size_t> start(mesh.vertex_count + 2, 0);
  const auto each_side = [&](const auto& visit) {
    for (std::size_t face = 0; face < mesh.face_count; ++face) {
      if (face % faces_between_checks == 0) check_interrupt();
      const std::uint32_t* v = corners[face];
      if (is_degenerate(v)) continue;
      visit(v[0], v[1], face), visit(v[1], v[2], face), visit(v[2], v[0], face);
    }
  };
  for (std::size_t face = 0; face < mesh.face_count; ++face) faults.degenerate += is_degenerate(corners[face]);
  each_side([&](std::uint32_t from, std::uint32_t to, std::size_t) { ++start[std::min(from, to) + std::size_t{2}]; });
  check_interrupt();
  for (std::size_t i = 2; i < start.size(); ++i) start[i] += start[i - 1];
  check_interrupt();
  std::vector<std::uint64_t> sides(start.back());
  each_side([&](std::uint32_t from, std::uint32_t to, std::size_t face) {
    const std::uint64_t low = std::min(from, to), other = std::max(from, to);
    sides[start[low + 1]++] = other << 32 | static_cast<std::uint64_t>(face) << 1 | (from < to);
  });
  for (std::size_t vertex = 0; vertex < mesh.vertex_count; ++vertex) {
    if (vertex % faces_between_checks == 0) check_interrupt();
    std::uint64_t* const begin = sides.data() + start[vertex];
    std::uint64_t* const end = sides.data() + start[vertex + 1];
    std::sort(begin, end);
    for (const std::uint64_t *edge = begin, *next = begin; edge != end; edge = next) {
      while (next != end && *next >> 32 == *edge >> 32) ++next;
      classify_edge(static_cast<std::uint32_t>(vertex), edge, next, faults, surfaces);
    }
  }
  return faults;
}

}  // namespace polhode::inertia
