#pragma once

#include "inertia/lanes/levels.hpp"
#include "polhode/math/detail/double_double.hpp"

// The sums over the triangles, for one lane type `Wide`. Each file that is built for one instruction set includes this
// header once, after `nmadd(a, b, c)` = c - a b and `load_rows<last>(vertices, indices, x, y, z)` for its `Wide`.
//
// The tetrahedron between the reference point and the triangle (a, b, c) has the volume d / 6, the first moments d s /
// 24 and the second moments d (p p + q q + o o) / 120 with d = a . (b x c), s = a + b + c, and the sums p, q, o of two
// corners (Mirtich 1996, Eberly 2002, whose a a + b b + c c + s s is the same). Here d = a . ((b - a) x (c - a)): the
// edges are short and nearly exact at any distance, whereas b x c of a small triangle loses most of its digits.
namespace polhode::POLHODE_ISA {

using inertia::mesh_sums;
using inertia::MeshSums;
using inertia::MeshTriangles;

inline constexpr int group = 8;         ///< virtual lanes, the same for every register width: equal bits
inline constexpr int block_groups = 32;  ///< groups in a plain sum; the sums of blocks are compensated

template <class T>
POLHODE_INLINE math::DoubleDouble<T> nmadd(math::DoubleDouble<T> a, math::DoubleDouble<T> b, math::DoubleDouble<T> c) {
  return c - a * b;
}

/// a - b in plain numbers, or exactly.
POLHODE_INLINE void difference(Wide a, Wide b, Wide& out) { out = a - b; }
POLHODE_INLINE void difference(Wide a, Wide b, math::DoubleDouble<Wide>& out) { out = math::two_diff(a, b); }

POLHODE_INLINE Wide plain(Wide a) { return a; }
POLHODE_INLINE Wide plain(math::DoubleDouble<Wide> a) { return a.hi; }

template <class N>
POLHODE_INLINE Wide square(const N (&v)[3]) {
  const Wide x = plain(v[0]), y = plain(v[1]), z = plain(v[2]);
  return madd(x, x, madd(y, y, z * z));
}

/// Adds the contributions of the triangles A, B, C in the lanes.
template <class N>
POLHODE_INLINE void add_triangles(const Wide (&A)[3], const Wide (&B)[3], const Wide (&C)[3], const Wide (&r)[3],
                                  N (&sum)[mesh_sums]) {
  N a[3], e[3], f[3], p[3], q[3], o[3];
  for (int k = 0; k < 3; ++k) {
    difference(A[k], r[k], a[k]);
    difference(B[k], A[k], e[k]);
    difference(C[k], A[k], f[k]);
    p[k] = madd(N(Wide(2.0)), a[k], e[k]);
    o[k] = madd(N(Wide(2.0)), a[k], f[k]);
    q[k] = p[k] + f[k];
  }
  const N nx = nmadd(e[2], f[1], e[1] * f[2]), ny = nmadd(e[0], f[2], e[2] * f[0]), nz = nmadd(e[1], f[0], e[0] * f[1]);
  const N d = madd(a[0], nx, madd(a[1], ny, a[2] * nz));
  sum[0] = sum[0] + d;
  for (int k = 0; k < 3; ++k) sum[1 + k] = madd(d, a[k] + q[k], sum[1 + k]);
  constexpr int row[6] = {0, 1, 2, 0, 0, 1}, column[6] = {0, 1, 2, 1, 2, 2};
  Wide distance(0.0);  // about twelve squares of it
  for (int m = 0; m < 6; ++m) {
    const int i = row[m], j = column[m];
    const N moment = madd(p[i], p[j], madd(q[i], q[j], o[i] * o[j]));
    sum[4 + m] = madd(d, moment, sum[4 + m]);
    if (m < 3) distance = distance + plain(moment);
  }
  // |e|^2 |f|^2 |a|^2 bounds d^2, and so the squared rounding error of d in units of rounding.
  sum[10] = madd(N(distance), N(square(e) * square(f)), sum[10]);
}

/// Calls take(part, sums) with the sums of `groups` times eight triangles. `last`: one of them has the last vertex,
/// beyond which nothing may be read.
template <bool last, class N, class Index, class Take>
POLHODE_INLINE void sum_block(const double* vertices, const Index* faces, int groups, const Wide (&r)[3],
                              const Take& take) {
  for (int part = 0; part < group / Wide::width; ++part) {
    N partial[mesh_sums];
    for (N& p : partial) p = N(Wide(0.0));
    const Index* corner = faces + 3 * part * Wide::width;
    for (int g = 0; g < groups; ++g, corner += 3 * group) {
      Wide A[3], B[3], C[3];
      load_rows<last>(vertices, corner, A[0], A[1], A[2]);
      load_rows<last>(vertices, corner + 1, B[0], B[1], B[2]);
      load_rows<last>(vertices, corner + 2, C[0], C[1], C[2]);
      add_triangles(A, B, C, r, partial);
    }
    take(part, partial);
  }
}

/// The sums of all blocks, compensated.
struct MeshTotal {
  math::DoubleDouble<Wide> sums[group / Wide::width][mesh_sums];

  POLHODE_INLINE MeshTotal() {
    for (auto& part : sums)
      for (auto& sum : part) sum = math::DoubleDouble<Wide>(Wide(0.0));
  }
  template <class N>
  POLHODE_INLINE void add(int part, const N (&partial)[mesh_sums]) {
    for (int m = 0; m < mesh_sums; ++m) sums[part][m] = sums[part][m] + partial[m];
  }
  void write(MeshSums& out) const {
    for (int m = 0; m < mesh_sums; ++m) {
      math::DD total(0.0);
      for (const auto& part : sums) {
        double hi[Wide::width], lo[Wide::width];
        part[m].hi.store(hi);
        part[m].lo.store(lo);
        for (int lane = 0; lane < Wide::width; ++lane) total = total + math::DD(hi[lane], lo[lane]);
      }
      out.hi[m] = total.hi;
      out.lo[m] = total.lo;
    }
  }
};

/// Calls take(part, sums) for each block, in order, and for the faces left over, and done() after each of them. Plain
/// in the block, or double-double. Returns false at an index out of range.
template <class N, class Index, class Take, class Done>
POLHODE_INLINE bool sum_blocks(const MeshTriangles<Index>& mesh, const Take& take, const Done& done) {
  const Wide r[3] = {Wide(mesh.reference[0]), Wide(mesh.reference[1]), Wide(mesh.reference[2])};
  constexpr std::size_t block = inertia::mesh_block;
  static_assert(block == std::size_t{group} * block_groups);
  for (std::size_t begin = 0; begin < mesh.face_count; begin += block) {
    const std::size_t rest = mesh.face_count - begin, count = rest < block ? rest : block;
    const Index* faces = mesh.faces + 3 * begin;
    Index lowest = 0, highest = 0;
    for (std::size_t i = 0; i < 3 * count; ++i) {
      lowest = faces[i] < lowest ? faces[i] : lowest;
      highest = highest < faces[i] ? faces[i] : highest;
    }
    if (lowest < 0 || static_cast<std::size_t>(highest) >= mesh.vertex_count) return false;
    const bool last = static_cast<std::size_t>(highest) + 1 == mesh.vertex_count;
    const int groups = static_cast<int>(count / group);
    if (last) {
      sum_block<true, N>(mesh.vertices, faces, groups, r, take);
    } else {
      sum_block<false, N>(mesh.vertices, faces, groups, r, take);
    }
    done();
    if (const std::size_t left = count % group; left != 0) {
      Index padded[3 * group];  // padded with triangles that are points and add nothing
      for (std::size_t i = 0; i < 3 * group; ++i) {
        padded[i] = i < 3 * left ? faces[3 * group * static_cast<std::size_t>(groups) + i] : faces[0];
      }
      sum_block<true, N>(mesh.vertices, padded, 1, r, take);
      done();
    }
  }
  return true;
}

template <class N, class Index>
bool mesh_loop(const MeshTriangles<Index>& mesh, MeshSums& out) {
  MeshTotal total;
  const auto add = [&total](int part, const N(&partial)[mesh_sums])
                       __attribute__((always_inline)) { total.add(part, partial); };
  if (!sum_blocks<N>(mesh, add, [] {})) return false;
  total.write(out);
  return true;
}

/// The sums of the blocks one after the other, for threads.
template <class Index>
bool mesh_rows(const MeshTriangles<Index>& mesh, double* rows) {
  const auto keep = [&rows](int part, const Wide(&partial)[mesh_sums]) __attribute__((always_inline)) {
    for (int m = 0; m < mesh_sums; ++m) partial[m].store(rows + group * m + part * Wide::width);
  };
  return sum_blocks<Wide>(mesh, keep, [&rows] { rows += inertia::mesh_row; });
}

/// Adds up rows as mesh_loop does.
inline void add_rows(const double* rows, std::size_t count, MeshSums& out) {
  static_assert(inertia::mesh_row == std::size_t{group} * mesh_sums);
  MeshTotal total;
  for (std::size_t i = 0; i < count; ++i, rows += inertia::mesh_row) {
    for (int part = 0; part < group / Wide::width; ++part) {
      Wide partial[mesh_sums];
      for (int m = 0; m < mesh_sums; ++m) partial[m] = Wide::load(rows + group * m + part * Wide::width);
      total.add(part, partial);
    }
  }
  total.write(out);
}

inline constexpr inertia::MeshKernels mesh_kernels = {
    &mesh_loop<Wide, std::int32_t>, &mesh_loop<math::DoubleDouble<Wide>, std::int32_t>,  //
    &mesh_loop<Wide, std::int64_t>, &mesh_loop<math::DoubleDouble<Wide>, std::int64_t>,  //
    &mesh_rows<std::int32_t>,       &mesh_rows<std::int64_t>,                            //
    &add_rows};

}  // namespace polhode::POLHODE_ISA
