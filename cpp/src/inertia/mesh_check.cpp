#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "inertia/mesh_edges.hpp"
#include "inertia/mesh_faces.hpp"
#include "inertia/mesh_holes.hpp"
#include "inertia/mesh_surfaces.hpp"
#include "inertia/mesh_weld.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/interrupt.hpp"

namespace polhode {
namespace {

using inertia::Corners;
using inertia::Faults;
using inertia::is_degenerate;
using inertia::Surface;
using inertia::Surfaces;

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

std::string text_of(const Faults& faults, const Corners& corners, const Mesh& mesh) {
  std::string found;
  const auto add = [&](const inertia::Fault& fault, const char* what) {
    if (fault.count() == 0) return;
    if (!found.empty()) found += ", ";
    found += fault.text(what);
  };
  add(faults.open, " open edges");
  add(faults.reversed, " edges between faces wound against each other");
  add(faults.crowded, " edges shared by more than two faces");
  const std::size_t repeated = found.empty() ? 0 : count_repeated(corners, mesh.face_count);
  if (repeated > 0) found += ", " + std::to_string(repeated) + " faces given again";
  return found;
}

std::string cause_of(const MeshReport& report) {
  if (report.closes_at > 0) {
    const std::string part = to_text(report.closes_at);
    return "open, but closed when vertices nearer than " + to_text(report.closes_at * report.size) +
           " are one: weld=" + part;
  }
  if (report.faults.find("given again") != std::string::npos) return "a part given twice?";
  if (report.open_edges > 0) return "a hole, or an edge of one face split in another?";
  return report.turned_edges > 0 ? "some faces are turned over" : "parts that touch along an edge?";
}

/// The corners of a surface, and what is wrong with its edges.
struct Judged {
  Corners corners;
  Surfaces roots;
  Faults faults;
};

Judged judge(Corners corners, const Mesh& mesh) {
  Surfaces roots(mesh.face_count);
  Faults faults = inertia::classify_edges(corners, mesh, roots);
  return {std::move(corners), std::move(roots), std::move(faults)};
}

/// With three vertices a face, as in STL files, no vertex is shared.
Judged judge_merged(const Mesh& mesh, bool& merged) {
  std::optional<Judged> first;
  if (mesh.vertex_count < 3 * mesh.face_count) {
    first = judge(Corners(mesh), mesh);
    if (first->faults.count() == 0) return std::move(*first);
  }
  merged = true;
  Corners corners(mesh);
  corners.merge(mesh);
  return judge(std::move(corners), mesh);
}

double box_size(const Corners& corners, const Mesh& mesh, MeshReport& report) {
  const auto place = [&](std::uint32_t v) { return Eigen::Map<const Vector3d>(mesh.vertices + 3 * std::size_t{v}); };
  report.low = report.high = place(corners[0][0]);
  for (std::size_t face = 0; face < mesh.face_count; ++face) {
    for (int k = 0; k < 3; ++k) {
      report.low = report.low.cwiseMin(place(corners[face][k]));
      report.high = report.high.cwiseMax(place(corners[face][k]));
    }
  }
  return (report.high - report.low).maxCoeff();
}

/// Takes vertices near each other as one, if that leaves fewer faults. Returns a volume: twice what the move can sweep.
double weld_faults(Judged& judged, const Mesh& mesh, double weld, MeshReport& report) {
  const std::vector<std::uint32_t> at = judged.faults.vertices();
  const inertia::Weld found = inertia::weld_vertices(mesh.vertices, at, weld * report.size);
  if (found.given_up == 0) return 0;
  std::vector<std::uint32_t> to(mesh.vertex_count);
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = static_cast<std::uint32_t>(i);
  for (std::size_t i = 0; i < at.size(); ++i) to[at[i]] = found.first[i];
  Judged welded = judge(judged.corners.replaced(to, mesh.face_count), mesh);
  if (welded.faults.count() >= judged.faults.count()) return 0;
  const auto place = [&](std::uint32_t v) { return Eigen::Map<const Vector3d>(mesh.vertices + 3 * std::size_t{v}); };
  double area = 0, length = 0;
  for (std::size_t face = 0; face < mesh.face_count; ++face) {
    const std::uint32_t* v = judged.corners[face];
    area += (place(v[1]) - place(v[0])).cross(place(v[2]) - place(v[0])).norm() / 2;
  }
  for (const inertia::FaultyEdge& edge : judged.faults.edges) length += (place(edge.low) - place(edge.high)).norm();
  report.welded = found.given_up;
  report.moved = found.moved;
  report.welded_faces = welded.corners.numbers(mesh.face_count);
  judged = std::move(welded);
  return 2 * found.moved * (area + 2 * report.size * length);
}

void require_weld(double weld) {
  if (weld == 0 || (weld >= 1e-15 && weld <= 0.01)) return;
  throw InvalidInput("weld", "0, or a part of the mesh's size from 1e-15 to 0.01", to_text(weld),
                     weld > 0.01 ? "a length? divide it by the size" : "");
}

}  // namespace

MeshReport examine_mesh(const Mesh& mesh, double weld) {
  require_weld(weld);
  inertia::require_indices(mesh);
  inertia::require_finite_vertices(mesh);
  MeshReport report;
  Judged judged = judge_merged(mesh, report.merged);
  double slack = 0;
  if (judged.faults.count() > 0) {
    report.size = box_size(judged.corners, mesh, report);
    if (report.size > 0 && weld > 0) slack = weld_faults(judged, mesh, weld, report);
  }
  const Faults& faults = judged.faults;
  report.open_edges = faults.open.count();
  report.turned_edges = faults.reversed.count();
  report.crowded_edges = faults.crowded.count();
  report.degenerate = faults.degenerate;
  const std::vector<Surface> surfaces = inertia::measure(judged.corners, mesh, judged.roots);
  if (surfaces.empty()) throw InvalidInput("faces", "round a positive volume", "only faces without area");
  report.components = surfaces.size();
  double volume = 0;
  report.low = surfaces[0].low, report.high = surfaces[0].high;
  for (const Surface& s : surfaces) {
    volume += s.volume;
    report.low = report.low.cwiseMin(s.low), report.high = report.high.cwiseMax(s.high);
  }
  report.size = (report.high - report.low).maxCoeff();
  report.inside_out = volume < 0;
  if (report.closed()) {
    inertia::check_nesting(surfaces, judged.corners, mesh, judged.roots, report);
    return report;
  }
  report.faults = text_of(faults, judged.corners, mesh);
  if (report.open_edges > 0 && report.size > 0) {
    report.closes_at =
        inertia::find_closing_weld(judged.corners, mesh, faults.vertices(), report.size, std::max(weld, 1e-15));
  }
  report.holes = inertia::measure_holes(faults.edges, mesh, slack, report.errors);
  return report;
}

MeshReport check_mesh(const Mesh& mesh, double weld) {
  MeshReport report = examine_mesh(mesh, weld);
  if (!report.closed()) {
    throw InvalidInput("faces", "a closed surface, every edge between two faces that pass it in opposite directions",
                       report.faults, cause_of(report));
  }
  if (report.strays > 0) {
    std::string found = "a surface of " + std::to_string(report.stray_faces) + " faces (first face ";
    found += std::to_string(report.stray_face) + ") that is wound inward and lies inside no other";
    throw InvalidInput("faces", "wound alike on every part, against it on cavities alone", found,
                       "a part turned inside out?");
  }
  return report;
}

}  // namespace polhode
