#include "inertia/mesh_holes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "polhode/core/error.hpp"
#include "polhode/core/interrupt.hpp"

// What a hole can change. A body's moments are sums of cones from a reference point r to its surface. The cones to the
// missing part are the error. That part differs from a fan, whose cones are known, by a region in a ball.
namespace polhode::inertia {
namespace {

using Loop = std::vector<std::uint32_t>;  // vertices, in the direction in which the faces pass

constexpr double infinity = std::numeric_limits<double>::infinity();

Vector3d place(const Mesh& mesh, std::uint32_t v) {
  return Eigen::Map<const Vector3d>(mesh.vertices + 3 * std::size_t{v});
}

/// A boundary has no boundary: as many edges leave each vertex as arrive. So a walk ends where it began, and each
/// vertex met twice closes a loop.
std::vector<Loop> loops_of(const std::vector<FaultyEdge>& edges) {
  std::vector<std::array<std::uint32_t, 2>> steps;
  for (const FaultyEdge& edge : edges) {
    for (int i = 0; i < edge.net; ++i) steps.push_back({edge.low, edge.high});
    for (int i = 0; i < -edge.net; ++i) steps.push_back({edge.high, edge.low});
  }
  std::sort(steps.begin(), steps.end());
  std::vector<std::uint32_t> names;
  for (const auto& step : steps)
    if (names.empty() || names.back() != step[0]) names.push_back(step[0]);
  const auto number = [&](std::uint32_t v) {
    return static_cast<std::size_t>(std::lower_bound(names.begin(), names.end(), v) - names.begin());
  };
  std::vector<std::size_t> next(names.size() + 1, steps.size());
  for (std::size_t i = steps.size(); i-- > 0;) next[number(steps[i][0])] = i;
  const std::vector<std::size_t> start = next;
  constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> where(names.size(), nowhere);
  std::vector<Loop> loops;
  Loop path;
  for (std::size_t v = 0; v < names.size(); ++v) {
    while (next[v] < start[v + 1]) {
      path.assign(1, names[v]);
      where[v] = 0;
      for (std::size_t at = v; next[at] < start[at + 1];) {
        const std::size_t to = number(steps[next[at]++][1]);
        if (where[to] == nowhere) {
          where[to] = path.size();
          path.push_back(names[to]);
        } else {
          const auto from = path.begin() + static_cast<std::ptrdiff_t>(where[to]);
          loops.emplace_back(from, path.end());
          for (auto one = from + 1; one != path.end(); ++one) where[number(*one)] = nowhere;
          path.erase(from + 1, path.end());
        }
        at = to;
      }
      where[v] = nowhere;
    }
  }
  check_interrupt();
  return loops;
}

/// Volume, first and second moments of tetrahedra.
struct Moments {
  double volume = 0;
  Vector3d first = Vector3d::Zero();
  Matrix3d second = Matrix3d::Zero();

  /// The tetrahedron between the origin and a triangle.
  void add(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
    const double d = a.dot(b.cross(c));
    const Vector3d s = a + b + c;
    volume += d / 6;
    first += d / 24 * s;
    second += d / 120 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + s * s.transpose());
  }
  void move_origin(const Vector3d& to) {
    second += volume * to * to.transpose() - first * to.transpose() - to * first.transpose();
    first -= volume * to;
  }
};

MeshHole measure_loop(const Loop& loop, const Mesh& mesh) {
  MeshHole hole;
  hole.edges = loop.size();
  const Vector3d origin = place(mesh, loop[0]);
  double length = 0;
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vector3d a = place(mesh, loop[i]) - origin, b = place(mesh, loop[(i + 1) % loop.size()]) - origin;
    const double edge = (b - a).norm();
    length += edge;
    sum += edge / 2 * (a + b);
  }
  hole.centre = length > 0 ? Vector3d(origin + sum / length) : origin;
  for (const std::uint32_t v : loop) hole.radius = std::max(hole.radius, (place(mesh, v) - hole.centre).norm());
  return hole;
}

Matrix3d inertia_of(const Matrix3d& second) { return second.trace() * Matrix3d::Identity() - second; }

}  // namespace

std::vector<MeshHole> measure_holes(const std::vector<FaultyEdge>& edges, const Mesh& mesh, double slack,
                                    MeshErrors& errors) {
  const std::vector<Loop> loops = loops_of(edges);
  std::vector<MeshHole> holes;
  for (const Loop& loop : loops) holes.push_back(measure_loop(loop, mesh));
  if (loops.empty() && slack == 0) return holes;
  errors = {infinity, infinity, infinity};
  try {
    const MeshIntegrals found = integrate_mesh(mesh);
    const double sign = found.volume.hi < 0 ? -1 : 1, volume = std::abs(found.volume.hi);
    const Vector3d r = found.reference;
    const Vector3d centre = Vector3d(found.centre[0].hi, found.centre[1].hi, found.centre[2].hi) - r;
    Moments fans;
    double reach = 0;
    for (std::size_t l = 0; l < loops.size(); ++l) {
      for (std::size_t i = 0; i < loops[l].size(); ++i) {
        const Vector3d a = place(mesh, loops[l][i]) - r, b = place(mesh, loops[l][(i + 1) % loops[l].size()]) - r;
        fans.add(b, a, holes[l].centre - r);
      }
      reach = std::max(reach, (holes[l].centre - r - centre).norm() + holes[l].radius);
    }
    fans.move_origin(centre);
    double ball[3] = {slack, slack * reach, slack * reach * reach};  // of the orders 0, 1, 2
    for (const MeshHole& hole : holes) {
      const double ball_volume = 4 * std::numbers::pi / 3 * hole.radius * hole.radius * hole.radius;
      const double D = (hole.centre - r - centre).norm() + hole.radius;
      ball[0] += ball_volume, ball[1] += ball_volume * D, ball[2] += ball_volume * D * D;
    }
    errors.mass = (std::abs(fans.volume) + ball[0]) / volume;
    const double least = volume + sign * fans.volume - ball[0];  // the least volume that the body can have
    const double first = fans.first.norm() + ball[1];
    if (least > 0) {
      Matrix3d second;
      second << found.second[0].hi, found.second[3].hi, found.second[4].hi,  //
          found.second[3].hi, found.second[1].hi, found.second[5].hi,        //
          found.second[4].hi, found.second[5].hi, found.second[2].hi;
      const double largest = compute_principal_axes(sign * inertia_of(second)).moments[2];
      errors.centre = first / least;
      const double change = inertia_of(fans.second).norm() + ball[2] + first * first / least;
      if (largest > 0) errors.inertia = change / largest;
    }
  } catch (const InvalidInput&) {  // flat, or empty: nothing to compare with
  }
  std::sort(holes.begin(), holes.end(), [](const MeshHole& a, const MeshHole& b) { return a.radius > b.radius; });
  return holes;
}

}  // namespace polhode::inertia
