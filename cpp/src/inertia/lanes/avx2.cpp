// Built with the flags of avx2 (cpp/CMakeLists.txt) where the compiler has them, else empty.
#include "inertia/lanes/levels.hpp"

#ifdef __AVX2__
#define POLHODE_ISA isa_avx2
#include "math/lanes/avx2.hpp"

namespace polhode::POLHODE_ISA {

POLHODE_INLINE Wide nmadd(Wide a, Wide b, Wide c) { return _mm256_fnmadd_pd(a.v, b.v, c.v); }

/// Four numbers, of which the fourth is not wanted; `last`: nor read.
template <bool last>
POLHODE_INLINE __m256d load_row(const double* p) {
  if constexpr (last) return _mm256_maskload_pd(p, _mm256_setr_epi64x(-1, -1, -1, 0));
  return _mm256_loadu_pd(p);
}

/// The vertices of every third index, four of them, as x, y and z: loads and shuffles are faster than gathers.
template <bool last, class Index>
POLHODE_INLINE void load_rows(const double* vertices, const Index* index, Wide& x, Wide& y, Wide& z) {
  __m256d row[4];
  for (int i = 0; i < 4; ++i) row[i] = load_row<last>(vertices + 3 * static_cast<std::ptrdiff_t>(index[3 * i]));
  const __m256d xz01 = _mm256_unpacklo_pd(row[0], row[1]), yw01 = _mm256_unpackhi_pd(row[0], row[1]);
  const __m256d xz23 = _mm256_unpacklo_pd(row[2], row[3]), yw23 = _mm256_unpackhi_pd(row[2], row[3]);
  x = _mm256_permute2f128_pd(xz01, xz23, 0x20);
  y = _mm256_permute2f128_pd(yw01, yw23, 0x20);
  z = _mm256_permute2f128_pd(xz01, xz23, 0x31);
}

}  // namespace polhode::POLHODE_ISA

#include "inertia/lanes/mesh_loops.hpp"

namespace polhode::inertia {
const MeshKernels* avx2_mesh_kernels() { return &POLHODE_ISA::mesh_kernels; }
}  // namespace polhode::inertia
#else
namespace polhode::inertia {
const MeshKernels* avx2_mesh_kernels() { return nullptr; }
}  // namespace polhode::inertia
#endif
