#include "inertia/mesh_faces.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "polhode/core/error.hpp"
#include "polhode/core/interrupt.hpp"

namespace polhode::inertia {
namespace {

/// Hash of three coordinates; -0 counts as 0.
std::uint64_t hash_of(const double* p) {
  std::uint64_t h = 0;
  for (int k = 0; k < 3; ++k) h = mixed(h * 31 + std::bit_cast<std::uint64_t>(p[k] + 0.0));
  return h;
}

/// For each vertex the first vertex at the same place.
std::vector<std::uint32_t> first_at_place(const double* vertices, std::size_t count) {
  constexpr std::uint32_t empty = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> table(std::bit_ceil(2 * count + 2), empty), first(count);
  const std::size_t mask = table.size() - 1;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % faces_between_checks == 0) check_interrupt();
    const double* p = vertices + 3 * i;
    first[i] = static_cast<std::uint32_t>(i);
    if (!(p[0] == p[0] && p[1] == p[1] && p[2] == p[2])) continue;  // NaN equals nothing
    std::size_t slot = hash_of(p) & mask;
    for (; table[slot] != empty; slot = (slot + 1) & mask) {
      const double* q = vertices + 3 * std::size_t{table[slot]};
      if (p[0] == q[0] && p[1] == q[1] && p[2] == q[2]) break;
    }
    if (table[slot] == empty) table[slot] = first[i];
    first[i] = table[slot];
  }
  return first;
}

template <class Visit>
void visit_indices(const Mesh& mesh, const Visit& visit) {
  std::visit(
      [&](const auto* faces) {
        const std::size_t count = 3 * mesh.face_count;
        for (std::size_t begin = 0; begin < count; begin += faces_between_checks) {
          check_interrupt();
          const std::size_t end = std::min(count, begin + faces_between_checks);
          for (std::size_t i = begin; i < end; ++i) visit(i, static_cast<std::int64_t>(faces[i]));
        }
      },
      mesh.faces);
}

std::string face_text(std::size_t corner) { return "face " + std::to_string(corner / 3); }

}  // namespace

void require_indices(const Mesh& mesh) {
  if (mesh.face_count == 0) throw InvalidInput("faces", "one triangle or more", "none");
  const std::uint64_t count = mesh.vertex_count;
  bool fits = true;
  visit_indices(mesh, [&](std::size_t, std::int64_t index) { fits &= static_cast<std::uint64_t>(index) < count; });
  if (fits) return;
  visit_indices(mesh, [&](std::size_t i, std::int64_t index) {
    if (static_cast<std::uint64_t>(index) < count) return;
    throw InvalidInput("faces", "numbers of vertices, from 0 to below " + std::to_string(count),
                       std::to_string(index) + " in " + face_text(i),
                       index == static_cast<std::int64_t>(count) ? "counted from 1?" : "");
  });
}

void require_finite_vertices(const Mesh& mesh) {
  visit_indices(mesh, [&](std::size_t i, std::int64_t index) {
    const double* p = mesh.vertices + 3 * index;
    if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) return;
    throw InvalidInput("vertices", "finite",
                       "(" + to_text(p[0]) + ", " + to_text(p[1]) + ", " + to_text(p[2]) + ") at vertex " +
                           std::to_string(index) + " of " + face_text(i));
  });
}

Corners::Corners(const Mesh& mesh) {
  constexpr std::size_t most = std::size_t{1} << 31;
  if (mesh.face_count >= most || mesh.vertex_count >= 2 * most) {
    throw InvalidInput("faces", "fewer than 2^31 faces and 2^32 vertices, to be checked",
                       std::to_string(mesh.face_count) + " faces, " + std::to_string(mesh.vertex_count) + " vertices");
  }
  if (const auto* faces = std::get_if<const std::int32_t*>(&mesh.faces)) {
    first_ = reinterpret_cast<const std::uint32_t*>(*faces);  // aliasing as the unsigned type is allowed
    return;
  }
  own_.resize(3 * mesh.face_count);
  visit_indices(mesh, [&](std::size_t i, std::int64_t index) { own_[i] = static_cast<std::uint32_t>(index); });
  first_ = own_.data();
}

void Corners::merge(const Mesh& mesh) {
  const std::vector<std::uint32_t> first = first_at_place(mesh.vertices, mesh.vertex_count);
  own_.resize(3 * mesh.face_count);
  visit_indices(mesh, [&](std::size_t i, std::int64_t index) { own_[i] = first[static_cast<std::size_t>(index)]; });
  first_ = own_.data();
}

Corners Corners::replaced(const std::vector<std::uint32_t>& by, std::size_t faces) const {
  Corners out;
  out.own_.resize(3 * faces);
  for (std::size_t i = 0; i < out.own_.size(); ++i) out.own_[i] = by[first_[i]];
  out.first_ = out.own_.data();
  return out;
}

}  // namespace polhode::inertia
