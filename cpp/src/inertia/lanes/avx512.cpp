// Built with the flags of avx512 (cpp/CMakeLists.txt) where the compiler has them, else empty.
#include "inertia/lanes/levels.hpp"

#ifdef __AVX512DQ__
#define POLHODE_ISA isa_avx512
#include "math/lanes/avx512.hpp"

namespace polhode::POLHODE_ISA {

POLHODE_INLINE Wide nmadd(Wide a, Wide b, Wide c) { return _mm512_fnmadd_pd(a.v, b.v, c.v); }

/// Four numbers, of which the fourth is not wanted; `last`: nor read.
template <bool last>
POLHODE_INLINE __m256d load_row(const double* p) {
  if constexpr (last) return _mm256_maskz_loadu_pd(0x7, p);
  return _mm256_loadu_pd(p);
}

/// The vertices of every third index, eight of them, as x, y and z: loads and shuffles are faster than gathers.
template <bool last, class Index>
POLHODE_INLINE void load_rows(const double* vertices, const Index* index, Wide& x, Wide& y, Wide& z) {
  __m512d row[4];  // lane i with lane i + 4 above
  for (int i = 0; i < 4; ++i) {
    const __m256d low = load_row<last>(vertices + 3 * static_cast<std::ptrdiff_t>(index[3 * i]));
    const __m256d high = load_row<last>(vertices + 3 * static_cast<std::ptrdiff_t>(index[3 * (i + 4)]));
    row[i] = _mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1);
  }
  const __m512d xz01 = _mm512_unpacklo_pd(row[0], row[1]), yw01 = _mm512_unpackhi_pd(row[0], row[1]);
  const __m512d xz23 = _mm512_unpacklo_pd(row[2], row[3]), yw23 = _mm512_unpackhi_pd(row[2], row[3]);
  const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 4, 5, 12, 13), high = _mm512_setr_epi64(2, 3, 10, 11, 6, 7, 14, 15);
  x = _mm512_permutex2var_pd(xz01, low, xz23);
  y = _mm512_permutex2var_pd(yw01, low, yw23);
  z = _mm512_permutex2var_pd(xz01, high, xz23);
}

}  // namespace polhode::POLHODE_ISA

#include "inertia/lanes/mesh_loops.hpp"

namespace polhode::inertia {
const MeshKernels* avx512_mesh_kernels() { return &POLHODE_ISA::mesh_kernels; }
}  // namespace polhode::inertia
#else
namespace polhode::inertia {
const MeshKernels* avx512_mesh_kernels() { return nullptr; }
}  // namespace polhode::inertia
#endif
