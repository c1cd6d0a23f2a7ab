#pragma once

#include <cstddef>
#include <cstdint>

namespace polhode::inertia {

/// The sums over the triangles: d, d s (3), d f (6: xx, yy, zz, xy, xz, yz), and the squared rounding error of d.
inline constexpr int mesh_sums = 11;

/// Sums over triangles, relative to `reference`. Each value is hi + lo.
struct MeshSums {
  double hi[mesh_sums], lo[mesh_sums];
};

template <class Index>
struct MeshTriangles {
  const double* vertices;
  std::size_t vertex_count;
  const Index* faces;
  std::size_t face_count;
  const double* reference;
};

/// Returns false when an index is out of range; the sums are then meaningless.
template <class Index>
using MeshLoop = bool (*)(const MeshTriangles<Index>&, MeshSums&);

inline constexpr std::size_t mesh_block = 256;          ///< faces in a plain sum
inline constexpr std::size_t mesh_row = 8 * mesh_sums;  ///< numbers in the sums of one block, eight lanes of each

/// Writes one row for each block and one for the last faces that are not eight.
template <class Index>
using MeshRows = bool (*)(const MeshTriangles<Index>&, double* rows);

/// `quick` in plain numbers with compensated sums of blocks, `fine` in double-double throughout. avx2 and avx512 give
/// the same bits. `rows` has the sums of blocks that `quick` adds up; `add` does that.
struct MeshKernels {
  MeshLoop<std::int32_t> quick32, fine32;
  MeshLoop<std::int64_t> quick64, fine64;
  MeshRows<std::int32_t> rows32;
  MeshRows<std::int64_t> rows64;
  void (*add)(const double* rows, std::size_t count, MeshSums&);
};

/// Null where the compiler could not build the level.
const MeshKernels* baseline_mesh_kernels();
const MeshKernels* avx2_mesh_kernels();
const MeshKernels* avx512_mesh_kernels();

}  // namespace polhode::inertia
