#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "inertia/mesh_faces.hpp"
#include "inertia/mesh_surfaces.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/interrupt.hpp"

// Every edge of a closed, oriented surface lies between two faces, which pass it in opposite directions. The sides of
// the faces are sorted by their lower vertex (counting sort), then by the other vertex.
namespace polhode {
namespace {

using inertia::Corners;
using inertia::is_degenerate;
using inertia::Surface;
using inertia::Surfaces;

/// The number of edges with a fault, and the first faces that have it.
class Fault {
 public:
  void add(std::uint32_t face, std::uint32_t another) {
    ++count_;
    note(face);
    note(another);
  }
  std::size_t count() const { return count_; }
  std::string text(const char* what) const {
    std::string out = std::to_string(count_);
    out += what;
    out += " (first faces ";
    for (std::size_t i = 0; i < kept_; ++i) {
      if (i > 0) out += ", ";
      out += std::to_string(faces_[i]);
    }
    return out + ")";
  }

 private:
  void note(std::uint32_t face) {
    for (std::size_t i = 0; i < kept_; ++i)
      if (faces_[i] == face) return;
    if (kept_ < faces_.size()) {
      faces_[kept_++] = face;
    } else if (face < faces_[kept_ - 1]) {
      faces_[kept_ - 1] = face;
    }
    std::sort(faces_.begin(), faces_.begin() + static_cast<std::ptrdiff_t>(kept_));
  }

  std::size_t count_ = 0, kept_ = 0;
  std::array<std::uint32_t, 3> faces_{};
};

struct Faults {
  Fault open, turned, crowded;
  std::size_t degenerate = 0;
  bool any() const { return open.count() + turned.count() + crowded.count() > 0; }
};

/// The sides of one edge, from `begin` to `end`. The lower 32 bits hold the face, and the direction in the last bit.
void classify_edge(const std::uint64_t* begin, const std::uint64_t* end, Faults& faults, Surfaces& surfaces) {
  const auto face = [](std::uint64_t side) { return static_cast<std::uint32_t>(side & 0xffffffffu) >> 1; };
  const std::uint32_t first = face(begin[0]), second = face(end[-1]);
  if (end - begin == 2 && ((begin[0] ^ begin[1]) & 1) == 1) return surfaces.join(first, second);
  (end - begin == 1 ? faults.open : end - begin == 2 ? faults.turned : faults.crowded).add(first, second);
}

Faults classify_edges(const Corners& corners, const Mesh& mesh, Surfaces& surfaces) {
  Faults faults;
  std::vector<std::size_t> start(mesh.vertex_count + 2, 0);
  const auto each_side = [&](const auto& visit) {
    for (std::size_t face = 0; face < mesh.face_count; ++face) {
      if (face % inertia::faces_between_checks == 0) check_interrupt();
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
    if (vertex % inertia::faces_between_checks == 0) check_interrupt();
    std::uint64_t* const begin = sides.data() + start[vertex];
    std::uint64_t* const end = sides.data() + start[vertex + 1];
    std::sort(begin, end);
    for (const std::uint64_t *edge = begin, *next = begin; edge != end; edge = next) {
      while (next != end && *next >> 32 == *edge >> 32) ++next;
      classify_edge(edge, next, faults, surfaces);
    }
  }
  return faults;
}

std::size_t count_repeated(const Corners& corners, std::size_t faces) {
  std::vector<std::array<std::uint32_t, 3>> keys(faces);
  for (std::size_t i = 0; i < faces; ++i) {
    keys[i] = {corners[i][0], corners[i][1], corners[i][2]};
    std::sort(keys[i].begin(), keys[i].end());
  }
  std::size_t compared = 0;
  std::sort(keys.begin(), keys.end(), [&](const auto& a, const auto& b) {
    if (++compared % inertia::faces_between_checks == 0) check_interrupt();
    return a < b;
  });
  std::size_t repeated = 0;
  for (std::size_t i = 1; i < faces; ++i) repeated += keys[i] == keys[i - 1] && !is_degenerate(keys[i].data());
  return repeated;
}

[[noreturn]] void refuse(const Faults& faults, const Corners& corners, const Mesh& mesh) {
  std::string found;
  const auto add = [&](const Fault& fault, const char* what) {
    if (fault.count() == 0) return;
    if (!found.empty()) found += ", ";
    found += fault.text(what);
  };
  add(faults.open, " open edges");
  add(faults.turned, " edges between faces wound against each other");
  add(faults.crowded, " edges shared by more than two faces");
  const std::size_t repeated = count_repeated(corners, mesh.face_count);
  if (repeated > 0) found += ", " + std::to_string(repeated) + " faces given again";
  throw InvalidInput("faces", "a closed surface, every edge between two faces that pass it in opposite directions",
                     found,
                     repeated > 0                ? "a part given twice?"
                     : faults.open.count() > 0   ? "a hole, or an edge of one face split in another?"
                     : faults.turned.count() > 0 ? "some faces are turned over"
                                                 : "parts that touch along an edge?");
}

}  // namespace

MeshReport check_mesh(const Mesh& mesh) {
  inertia::require_indices(mesh);
  inertia::require_finite_vertices(mesh);
  MeshReport report;
  Corners corners(mesh);
  Surfaces roots(mesh.face_count);
  // With three vertices a face, as in STL files, no vertex is shared.
  Faults faults;
  const bool soup = mesh.vertex_count >= 3 * mesh.face_count;
  if (!soup) faults = classify_edges(corners, mesh, roots);
  if (soup || faults.any()) {
    corners.merge(mesh);
    roots = Surfaces(mesh.face_count);
    faults = classify_edges(corners, mesh, roots);
    report.merged = true;
  }
  if (faults.any()) refuse(faults, corners, mesh);
  report.degenerate = faults.degenerate;
  const std::vector<Surface> surfaces = inertia::measure(corners, mesh, roots);
  if (surfaces.empty()) throw InvalidInput("faces", "round a positive volume", "only faces without area");
  report.components = surfaces.size();
  double volume = 0;
  report.low = surfaces[0].low, report.high = surfaces[0].high;
  for (const Surface& s : surfaces) {
    volume += s.volume;
    report.low = report.low.cwiseMin(s.low), report.high = report.high.cwiseMax(s.high);
  }
  report.inside_out = volume < 0;
  inertia::check_nesting(surfaces, corners, mesh, roots, report);
  return report;
}

}  // namespace polhode
