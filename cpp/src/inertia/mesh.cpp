#include "polhode/inertia/mesh.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>

#include "core/choose_level.hpp"
#include "core/parallel.hpp"
#include "inertia/lanes/levels.hpp"
#include "inertia/mesh_faces.hpp"
#include "inertia/validation.hpp"
#include "polhode/core/error.hpp"

namespace polhode {
namespace {

using inertia::MeshKernels;
using inertia::MeshSums;
using math::DD;

/// Fewer triangles are always integrated in double-double. It takes no noticeable time, and few errors average out.
constexpr std::size_t few_triangles = 1024;

/// Plain numbers suffice under two conditions. The accumulated rounding, for independent errors, is at most
/// `noise_limit` units of rounding of the volume. The second moments about the reference point are at most
/// `magnification_limit` times those about the centre.
constexpr double noise_limit = 0.25, magnification_limit = 8;

const MeshKernels& mesh_kernels(SimdLevel level) {
  return *choose_level(level, inertia::baseline_mesh_kernels, inertia::avx2_mesh_kernels, inertia::avx512_mesh_kernels);
}

/// The mean of some vertices spread over the faces: a point near the body, mostly inside.
Vector3d reference_point(const Mesh& mesh) {
  constexpr std::size_t most = 64;
  const std::size_t step = mesh.face_count / most + 1;
  Vector3d sum = Vector3d::Zero(), origin = Vector3d::Zero();
  std::size_t count = 0;
  std::visit(
      [&](const auto* faces) {
        for (std::size_t i = 0; i < mesh.face_count; i += step) {
          const auto index = static_cast<std::uint64_t>(faces[3 * i]);
          if (index >= mesh.vertex_count) continue;  // mesh_loop reports it
          const Vector3d p = Eigen::Map<const Vector3d>(mesh.vertices + 3 * index);
          if (count == 0) origin = p;
          sum += p - origin;
          ++count;
        }
      },
      mesh.faces);
  return origin + sum / static_cast<double>(count);
}

/// Each thread sums blocks of its own. They are added up in their order, so the bits are those of one thread.
template <class Index>
bool run_threads(inertia::MeshRows<Index> rows_of, const MeshKernels& kernels,
                 const inertia::MeshTriangles<Index>& mesh, std::size_t threads, MeshSums& sums) {
  const std::size_t blocks = (mesh.face_count + inertia::mesh_block - 1) / inertia::mesh_block;
  const std::size_t count = blocks + (mesh.face_count % 8 != 0);
  const auto rows = std::make_unique_for_overwrite<double[]>(count * inertia::mesh_row);
  std::atomic<bool> fits{true};
  parallel_for(blocks, threads, 1, [&](std::size_t begin, std::size_t end) {
    inertia::MeshTriangles<Index> part = mesh;
    part.faces += 3 * inertia::mesh_block * begin;
    part.face_count = std::min(mesh.face_count, inertia::mesh_block * end) - inertia::mesh_block * begin;
    if (!rows_of(part, rows.get() + inertia::mesh_row * begin)) fits = false;
  });
  if (fits) kernels.add(rows.get(), count, sums);
  return fits;
}

void run(const MeshKernels& kernels, const Mesh& mesh, const Vector3d& reference, bool fine, std::size_t threads,
         MeshSums& sums) {
  const auto triangles = [&](const auto* faces) {
    return inertia::MeshTriangles<std::remove_cvref_t<decltype(*faces)>>{mesh.vertices, mesh.vertex_count, faces,
                                                                       mesh.face_count, reference.data()};
  };
  bool fits = false;
  if (threads > 1 && !fine) {
    if (const auto* narrow = std::get_if<const std::int32_t*>(&mesh.faces)) {
      fits = run_threads(kernels.rows32, kernels, triangles(*narrow), threads, sums);
    } else {
      fits = run_threads(kernels.rows64, kernels, triangles(std::get<const std::int64_t*>(mesh.faces)), threads, sums);
    }
    if (!fits) inertia::require_indices(mesh);
    return;
  }
  if (const auto* narrow = std::get_if<const std::int32_t*>(&mesh.faces)) {
    fits = (fine ? kernels.fine32 : kernels.quick32)(triangles(*narrow), sums);
  } else {
    fits = (fine ? kernels.fine64 : kernels.quick64)(triangles(std::get<const std::int64_t*>(mesh.faces)), sums);
  }
  if (!fits) inertia::require_indices(mesh);
}

/// Integrals from the sums over d, d s and d f: V = d / 6, V c = d s / 24, and d f / 120 - V c c about the centre c.
MeshIntegrals integrals(const MeshSums& sums, const Vector3d& reference) {
  const auto sum = [&](int m) { return DD(sums.hi[m], sums.lo[m]); };
  MeshIntegrals out;
  out.reference = reference;
  out.volume = sum(0) / DD(6.0);
  DD centre[3];  // from the reference point
  for (int k = 0; k < 3; ++k) {
    centre[k] = sum(1 + k) / (DD(4.0) * sum(0));
    out.centre[k] = DD(reference[k]) + centre[k];
  }
  constexpr int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
  for (int m = 0; m < 6; ++m) out.second[m] = sum(4 + m) / DD(120.0) - out.volume * centre[row[m]] * centre[column[m]];
  return out;
}

/// Replaces by zero what is rounding in double-double, at the 93rd bit: a symmetric body has exact zeros.
void clear_rounding(MeshIntegrals& mesh) {
  constexpr double part = 1e-28;
  const double trace = std::abs(mesh.second[0].hi + mesh.second[1].hi + mesh.second[2].hi);
  const double size = std::sqrt(trace / std::abs(mesh.volume.hi));
  for (int m = 3; m < 6; ++m)
    if (std::abs(mesh.second[m].hi) <= part * trace) mesh.second[m] = DD(0.0);
  for (DD& c : mesh.centre)
    if (std::abs(c.hi) <= part * size) c = DD(0.0);
}

bool plain_suffices(const MeshSums& sums, const MeshIntegrals& found) {
  const double about_reference = sums.hi[4] + sums.hi[5] + sums.hi[6];
  const double about_centre = 120 * (found.second[0].hi + found.second[1].hi + found.second[2].hi);
  return std::sqrt(sums.hi[10] / 12) <= noise_limit * std::abs(sums.hi[0]) &&
         std::abs(about_reference) <= magnification_limit * std::abs(about_centre);
}

/// unit^exponent: the factor of lengths (1), volumes (3) and second moments (5). A unit of whole tenths of a micrometre
/// is taken as that decimal number exactly: 0.001 means 1/1000, which is no double.
DD power(double unit, int exponent) {
  const double whole = std::round(unit * 1e7);
  const DD factor = whole / 1e7 == unit ? DD(whole) / DD(1e7) : DD(unit);
  DD result(1.0);
  for (int i = 0; i < exponent; ++i) result = result * factor;
  return result;
}

MassProperties scaled(const MeshIntegrals& mesh, DD mass, DD density, double unit) {
  const DD length = power(unit, 1), moment = density * power(unit, 5);
  Vector3d com;
  for (int k = 0; k < 3; ++k) com[k] = (mesh.centre[k] * length).hi;
  const auto& C = mesh.second;
  const auto entry = [&](DD value) { return (value * moment).hi; };
  const double xy = entry(-C[3]), xz = entry(-C[4]), yz = entry(-C[5]);
  Matrix3d I;
  I << entry(C[1] + C[2]), xy, xz, xy, entry(C[0] + C[2]), yz, xz, yz, entry(C[0] + C[1]);
  return MassProperties(mass.hi, com, InertiaTensor(I));
}

void require_body(const MeshIntegrals& mesh, double unit) {
  inertia::positive(unit, "unit");
  if (mesh.volume.hi > 0) return;
  constexpr const char* reversed = "inside out: every face wound the wrong way? repair=\"flip\" turns them";
  throw InvalidInput("faces", "round a positive volume", to_text(mesh.volume.hi), mesh.volume.hi < 0 ? reversed : "");
}

}  // namespace

void MeshIntegrals::flip() {
  volume = -volume;
  for (DD& moment : second) moment = -moment;
  flipped = !flipped;
}

MassProperties MeshIntegrals::with_density(double density, double unit) const {
  inertia::positive(density, "density");
  require_body(*this, unit);
  return scaled(*this, volume * DD(density) * power(unit, 3), DD(density), unit);
}

MassProperties MeshIntegrals::with_mass(double mass, double unit) const {
  inertia::positive(mass, "mass");
  require_body(*this, unit);
  return scaled(*this, DD(mass), DD(mass) / (volume * power(unit, 3)), unit);
}

MeshIntegrals integrate_mesh(const Mesh& mesh) { return integrate_mesh(mesh, simd_level()); }

MeshIntegrals integrate_mesh(const Mesh& mesh, SimdLevel level, int threads) {
  if (mesh.face_count == 0) inertia::require_indices(mesh);
  const MeshKernels& kernels = mesh_kernels(level);
  const Vector3d reference = reference_point(mesh);
  MeshSums sums;
  MeshIntegrals found;
  bool refined = mesh.face_count <= few_triangles;
  if (!refined) {
    // Two threads read most of what the memory gives.
    const std::size_t most = threads > 0 ? static_cast<std::size_t>(threads) : 2;
    run(kernels, mesh, reference, false, std::min(most, thread_count(threads, mesh.face_count, 100000)), sums);
    found = integrals(sums, reference);
    refined = !plain_suffices(sums, found);
  }
  if (refined) {
    run(kernels, mesh, reference, true, 1, sums);
    found = integrals(sums, reference);
    clear_rounding(found);
  }
  found.refined = refined;
  const double size = sums.hi[10];
  if (!std::isfinite(size)) inertia::require_finite_vertices(mesh);
  if (!(size >= 1e-280 && size <= 1e280)) {
    throw InvalidInput("vertices", "of a mesh between 1e-45 and 1e45 in size",
                       "a larger or smaller one, or only faces without area");
  }
  // A volume of zero leaves rounding at the 100th bit.
  if (std::abs(found.volume.hi) <= 1e-29 * std::sqrt(size)) {
    throw InvalidInput("faces", "round a positive volume", "a surface that encloses none", "a flat or an empty body?");
  }
  return found;
}

}  // namespace polhode
