#include "inertia/mesh_surfaces.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "polhode/core/interrupt.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode::inertia {
namespace {

/// The most solid angles to compute, about 0.1 s. In a mesh of many entangled parts the rest is not checked.
constexpr std::size_t most_angles = 4'000'000;

Vector3d vertex(const Mesh& mesh, std::uint32_t v) {
  return Eigen::Map<const Vector3d>(mesh.vertices + 3 * std::size_t{v});
}

/// The faces, grouped by surface.
class FacesOf {
 public:
  FacesOf(const std::vector<Surface>& surfaces, const Corners& corners, std::size_t count, Surfaces& roots)
      : start_(surfaces.size() + 1, 0) {
    std::vector<std::uint32_t> place(count);
    for (std::uint32_t i = 0; i < surfaces.size(); ++i) {
      place[surfaces[i].first_face] = i;
      start_[i + 1] = start_[i] + surfaces[i].faces;
    }
    faces_.resize(start_.back());
    std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
    for (std::uint32_t face = 0; face < count; ++face)
      if (!is_degenerate(corners[face])) faces_[next[place[roots.root(face)]]++] = face;
  }
  const std::uint32_t* begin(std::size_t surface) const { return faces_.data() + start_[surface]; }
  const std::uint32_t* end(std::size_t surface) const { return faces_.data() + start_[surface + 1]; }

 private:
  std::vector<std::size_t> start_;
  std::vector<std::uint32_t> faces_;
};

/// The winding number of faces about a point: the sum of their solid angles over 4 pi.
/// Van Oosterom and Strackee 1983, IEEE Trans. Biomed. Eng. 30, 125.
double winding(const Vector3d& point, const std::uint32_t* face, const std::uint32_t* end, const Corners& corners,
               const Mesh& mesh) {
  double sum = 0;
  for (const std::uint32_t* const first = face; face != end; ++face) {
    if (static_cast<std::size_t>(face - first) % faces_between_checks == 0) check_interrupt();
    const std::uint32_t* v = corners[*face];
    const Vector3d a = vertex(mesh, v[0]) - point, b = vertex(mesh, v[1]) - point, c = vertex(mesh, v[2]) - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum += math::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * std::numbers::pi);
}

}  // namespace

std::vector<Surface> measure(const Corners& corners, const Mesh& mesh, Surfaces& roots) {
  std::vector<std::uint32_t> place(mesh.face_count);
  std::vector<Surface> surfaces;
  for (std::uint32_t face = 0; face < mesh.face_count; ++face) {
    if (face % faces_between_checks == 0) check_interrupt();
    const std::uint32_t* v = corners[face];
    if (is_degenerate(v)) continue;
    const std::uint32_t root = roots.root(face);
    if (root == face) {
      place[face] = static_cast<std::uint32_t>(surfaces.size());
      surfaces.emplace_back().first_face = face;
    }
    Surface& s = surfaces[place[root]];
    const Vector3d a = vertex(mesh, v[0]), b = vertex(mesh, v[1]), c = vertex(mesh, v[2]);
    s.low = s.low.cwiseMin(a).cwiseMin(b).cwiseMin(c);
    s.high = s.high.cwiseMax(a).cwiseMax(b).cwiseMax(c);
    const Vector3d from_first = a - vertex(mesh, corners[s.first_face][0]), e = b - a, f = c - a;
    const Vector3d normal = e.cross(f);
    s.volume += from_first.dot(normal);
    s.rounding += 1e-12 * from_first.norm() * normal.norm();
    ++s.faces;
  }
  return surfaces;
}

void check_nesting(const std::vector<Surface>& surfaces, const Corners& corners, const Mesh& mesh, Surfaces& roots,
                   MeshReport& report) {
  const double outward = report.inside_out ? -1 : 1;
  for (const Surface& s : surfaces) report.cavities += s.is_wound(-outward);
  if (surfaces.size() < 2) return;
  const FacesOf faces(surfaces, corners, mesh.face_count, roots);
  std::size_t angles = 0;
  for (const bool cavity : {true, false}) {  // cavities first: their fault is the graver one
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      if (!surfaces[i].is_wound(cavity ? -outward : outward)) continue;
      if (angles > most_angles) {
        ++report.unjudged;
        continue;
      }
      const Vector3d point = vertex(mesh, corners[surfaces[i].first_face][0]);
      double round = 0;
      for (std::size_t j = 0; j < surfaces.size(); ++j) {
        if (j == i || !surfaces[j].holds(point)) continue;
        round += outward * winding(point, faces.begin(j), faces.end(j), corners, mesh);
        angles += surfaces[j].faces;
      }
      angles += surfaces.size() / 16;  // the cost of the box tests
      if (!cavity) report.embedded += round > 0.75;
      if (!cavity || round > 0.25) continue;  // between 0.25 and 0.75 the point lies on the other surface
      if (report.strays++ > 0) continue;
      report.stray_face = surfaces[i].first_face;
      report.stray_faces = surfaces[i].faces;
    }
  }
}

}  // namespace polhode::inertia
