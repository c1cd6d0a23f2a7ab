#include "inertia/mesh_weld.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>

#include "polhode/core/interrupt.hpp"

namespace polhode::inertia {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

using Cell = std::array<std::int64_t, 3>;

/// Steps to the cells that can hold a vertex nearer than the distance, one of each opposite two. A cell's diagonal is
/// that distance, so the corner cells of 5 x 5 x 5 are too far away.
std::vector<Cell> near_cells() {
  std::vector<Cell> steps;
  for (std::int64_t x = 0; x <= 2; ++x)
    for (std::int64_t y = -2; y <= 2; ++y)
      for (std::int64_t z = -2; z <= 2; ++z) {
        if (Cell{x, y, z} > Cell{0, 0, 0} && x * x + y * y + z * z < 12) steps.push_back({x, y, z});
      }
  return steps;
}

/// The occupied cells of a grid, with their vertices as linked lists.
class Grid {
 public:
  Grid(const std::vector<Vector3d>& points, double side)
      : next_(points.size(), none), table_(std::bit_ceil(2 * points.size() + 2), none) {
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const Vector3d place = (points[i] / side).array().floor();
      const Cell cell{static_cast<std::int64_t>(place[0]), static_cast<std::int64_t>(place[1]),
                      static_cast<std::int64_t>(place[2])};
      const std::size_t slot = slot_of(cell);
      if (table_[slot] == none) {
        table_[slot] = static_cast<std::uint32_t>(cells_.size());
        cells_.push_back(cell);
        first_.push_back(i);
        last_.push_back(i);
      } else {
        std::uint32_t& last = last_[table_[slot]];
        last = next_[last] = i;
      }
    }
  }
  std::uint32_t count() const { return static_cast<std::uint32_t>(cells_.size()); }
  std::uint32_t first(std::uint32_t cell) const { return first_[cell]; }
  std::uint32_t next(std::uint32_t point) const { return next_[point]; }
  std::uint32_t find(std::uint32_t from, const Cell& step) const {
    const Cell& c = cells_[from];
    return table_[slot_of({c[0] + step[0], c[1] + step[1], c[2] + step[2]})];
  }

 private:
  std::size_t slot_of(const Cell& cell) const {
    std::uint64_t h = 0;
    for (const std::int64_t c : cell) h = mixed(h * 31 + static_cast<std::uint64_t>(c));
    const std::size_t mask = table_.size() - 1;
    std::size_t slot = h & mask;
    while (table_[slot] != none && cells_[table_[slot]] != cell) slot = (slot + 1) & mask;
    return slot;
  }

  std::vector<std::uint32_t> next_, table_, first_, last_;
  std::vector<Cell> cells_;
};

/// The points as parts of the distance, from their lowest corner. None if that leaves the range of the cells' numbers.
std::vector<Vector3d> scaled(const double* coordinates, const std::vector<std::uint32_t>& vertices, double distance) {
  std::vector<Vector3d> points;
  points.reserve(vertices.size());
  for (const std::uint32_t v : vertices) {
    points.emplace_back(Eigen::Map<const Vector3d>(coordinates + 3 * std::size_t{v}));
  }
  Vector3d low = points[0], high = low;
  for (const Vector3d& p : points) low = low.cwiseMin(p), high = high.cwiseMax(p);
  // Beyond it cells have no number: the mesh is too large for float64, or the distance too small.
  if (!((high - low).array() / distance < 0x1p62).all()) return {};
  for (Vector3d& p : points) p = (p - low) / distance;
  return points;
}

/// Are all edges at some vertices between two faces that pass them in opposite directions?
bool is_closed(const std::vector<std::array<std::uint32_t, 3>>& faces, const std::vector<std::uint32_t>& to) {
  std::vector<std::uint64_t> sides;  // of edges with an end at a listed vertex: below to.size()
  for (const auto& face : faces) {
    std::array<std::uint32_t, 3> v = face;
    for (std::uint32_t& one : v) one = one < to.size() ? to[one] : one;
    if (is_degenerate(v.data())) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t a = v[k], b = v[(k + 1) % 3];
      if (std::min(a, b) < to.size()) sides.push_back(std::min(a, b) << 33 | std::max(a, b) << 1 | (a < b));
    }
  }
  check_interrupt();
  std::sort(sides.begin(), sides.end());
  if (sides.size() % 2 != 0) return false;
  for (std::size_t i = 0; i < sides.size(); i += 2) {
    if ((sides[i] ^ sides[i + 1]) != 1) return false;               // the edge once, or twice alike
    if (i > 0 && sides[i - 1] >> 1 == sides[i] >> 1) return false;  // four times
  }
  return true;
}

}  // namespace

Weld weld_vertices(const double* coordinates, const std::vector<std::uint32_t>& vertices, double distance) {
  static const auto& steps = *new const std::vector<Cell>(near_cells());   // never destroyed, as threads may go on
  const std::vector<Vector3d> points = scaled(coordinates, vertices, distance);
  if (points.empty()) return {vertices};
  const Grid grid(points, 0.999 / std::sqrt(3.0));
  Surfaces groups(points.size());  // of vertices: the root is the first
  for (std::uint32_t cell = 0; cell < grid.count(); ++cell) {
    if (cell % faces_between_checks == 0) check_interrupt();
    const std::uint32_t first = grid.first(cell);
    for (std::uint32_t i = grid.next(first); i != none; i = grid.next(i)) groups.join(first, i);
  }
  const auto touch = [&](std::uint32_t a, std::uint32_t b) {
    for (std::uint32_t i = grid.first(a); i != none; i = grid.next(i)) {
      for (std::uint32_t j = grid.first(b); j != none; j = grid.next(j))
        if ((points[i] - points[j]).squaredNorm() < 1) return true;
    }
    return false;
  };
  for (std::uint32_t cell = 0; cell < grid.count(); ++cell) {
    if (cell % 1024 == 0) check_interrupt();
    for (const Cell& step : steps) {
      const std::uint32_t other = grid.find(cell, step);
      if (other == none || groups.root(grid.first(cell)) == groups.root(grid.first(other))) continue;
      if (touch(cell, other)) groups.join(grid.first(cell), grid.first(other));
    }
  }
  Weld weld;
  weld.first.resize(vertices.size());
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    const std::uint32_t first = groups.root(i);
    weld.first[i] = vertices[first];
    weld.given_up += first != i;
    weld.moved = std::max(weld.moved, (points[i] - points[first]).norm() * distance);
  }
  return weld;
}

double find_closing_weld(const Corners& corners, const Mesh& mesh, const std::vector<std::uint32_t>& at_faults,
                         double size, double least) {
  // Numbers of their own: first the listed vertices, in their order, then all others as they are, moved up. Only faces
  // with a listed corner can change.
  const auto count = static_cast<std::uint32_t>(at_faults.size());
  std::vector<std::uint32_t> number(mesh.vertex_count, none);
  for (std::uint32_t i = 0; i < count; ++i) number[at_faults[i]] = i;
  std::vector<std::array<std::uint32_t, 3>> faces;
  std::uint32_t others = count;
  for (std::size_t face = 0; face < mesh.face_count; ++face) {
    const std::uint32_t* v = corners[face];
    const auto is_listed = [&](std::uint32_t one) { return number[one] < count; };
    if (!is_listed(v[0]) && !is_listed(v[1]) && !is_listed(v[2])) continue;
    for (int k = 0; k < 3; ++k)
      if (number[v[k]] == none) number[v[k]] = others++;
    faces.push_back({number[v[0]], number[v[1]], number[v[2]]});
  }
  const auto closes = [&](double weld) {
    const Weld found = weld_vertices(mesh.vertices, at_faults, weld * size);
    std::vector<std::uint32_t> to(count);
    for (std::uint32_t i = 0; i < count; ++i) to[i] = number[found.first[i]];
    return found.given_up > 0 && is_closed(faces, to);
  };
  constexpr double most = 0.01;
  double high = std::max(least, 1e-15), low = high;
  while (high < most && !closes(high)) {
    low = high;
    high = std::min(most, 10 * high);
  }
  if (high == most && !closes(most)) return 0;
  for (int i = 0; i < 10 && high > 1.01 * low; ++i) {
    const double middle = std::sqrt(low * high);
    (closes(middle) ? high : low) = middle;
  }
  double digit = 1e-17;
  while (100 * digit < high) digit *= 10;
  const double rounded = std::ceil(high / digit) * digit;
  return rounded <= most && closes(rounded) ? rounded : high;
}

}  // namespace polhode::inertia
