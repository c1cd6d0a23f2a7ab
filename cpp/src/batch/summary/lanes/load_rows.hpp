#pragma once

#include <bit>
#include <cstdint>

#include "polhode/math/detail/number.hpp"

// Rows of three and four numbers into registers, one a component; and bins from a number's bits. The other way is in
// math/lanes. Each file that is built for one instruction set includes this after `Wide`.
namespace polhode::POLHODE_ISA {

/// The bits above the lowest 46: sign, exponent, and 6 bits of the mantissa.
#if defined(__AVX512DQ__)

POLHODE_INLINE void load4(const double* p, Wide& x, Wide& y, Wide& z, Wide& w) {
  const __m512d a = _mm512_loadu_pd(p), b = _mm512_loadu_pd(p + 8), c = _mm512_loadu_pd(p + 16),
                d = _mm512_loadu_pd(p + 24);
  const __m512i xy = _mm512_setr_epi64(0, 4, 8, 12, 1, 5, 9, 13), zw = _mm512_setr_epi64(2, 6, 10, 14, 3, 7, 11, 15);
  const __m512d xy0 = _mm512_permutex2var_pd(a, xy, b), xy1 = _mm512_permutex2var_pd(c, xy, d);
  const __m512d zw0 = _mm512_permutex2var_pd(a, zw, b), zw1 = _mm512_permutex2var_pd(c, zw, d);
  x = _mm512_shuffle_f64x2(xy0, xy1, 0x44), y = _mm512_shuffle_f64x2(xy0, xy1, 0xee);
  z = _mm512_shuffle_f64x2(zw0, zw1, 0x44), w = _mm512_shuffle_f64x2(zw0, zw1, 0xee);
}

POLHODE_INLINE void load3(const double* p, Wide& x, Wide& y, Wide& z) {
  const __m512d a = _mm512_loadu_pd(p), b = _mm512_loadu_pd(p + 8), c = _mm512_loadu_pd(p + 16);
  const __m512d p0 = _mm512_permutex2var_pd(a, _mm512_setr_epi64(0, 3, 6, 9, 12, 15, 0, 0), b);
  const __m512d p1 = _mm512_permutex2var_pd(a, _mm512_setr_epi64(1, 4, 7, 10, 13, 0, 0, 0), b);
  const __m512d p2 = _mm512_permutex2var_pd(a, _mm512_setr_epi64(2, 5, 8, 11, 14, 0, 0, 0), b);
  x = _mm512_permutex2var_pd(p0, _mm512_setr_epi64(0, 1, 2, 3, 4, 5, 10, 13), c);
  y = _mm512_permutex2var_pd(p1, _mm512_setr_epi64(0, 1, 2, 3, 4, 8, 11, 14), c);
  z = _mm512_permutex2var_pd(p2, _mm512_setr_epi64(0, 1, 2, 3, 4, 9, 12, 15), c);
}

POLHODE_INLINE void store_bits(std::int64_t* to, Wide a) {
  _mm512_storeu_si512(to, _mm512_srli_epi64(_mm512_castpd_si512(a.v), 46));
}

#elif defined(__AVX2__)

POLHODE_INLINE void load4(const double* p, Wide& x, Wide& y, Wide& z, Wide& w) {
  const __m256d a = _mm256_loadu_pd(p), b = _mm256_loadu_pd(p + 4), c = _mm256_loadu_pd(p + 8),
                d = _mm256_loadu_pd(p + 12);
  const __m256d xz0 = _mm256_unpacklo_pd(a, b), yw0 = _mm256_unpackhi_pd(a, b);
  const __m256d xz1 = _mm256_unpacklo_pd(c, d), yw1 = _mm256_unpackhi_pd(c, d);
  x = _mm256_permute2f128_pd(xz0, xz1, 0x20), z = _mm256_permute2f128_pd(xz0, xz1, 0x31);
  y = _mm256_permute2f128_pd(yw0, yw1, 0x20), w = _mm256_permute2f128_pd(yw0, yw1, 0x31);
}

POLHODE_INLINE void load3(const double* p, Wide& x, Wide& y, Wide& z) {
  const __m256d a = _mm256_loadu_pd(p), b = _mm256_loadu_pd(p + 4), c = _mm256_loadu_pd(p + 8);
  const __m256d xy = _mm256_permute2f128_pd(a, b, 0x30), zx = _mm256_permute2f128_pd(a, c, 0x21),
                yz = _mm256_permute2f128_pd(b, c, 0x30);
  x = _mm256_shuffle_pd(xy, zx, 0b1010), y = _mm256_shuffle_pd(xy, yz, 0b0101), z = _mm256_shuffle_pd(zx, yz, 0b1010);
}

POLHODE_INLINE void store_bits(std::int64_t* to, Wide a) {
  _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), _mm256_srli_epi64(_mm256_castpd_si256(a.v), 46));
}

#else

POLHODE_INLINE void load4(const double* p, Wide& x, Wide& y, Wide& z, Wide& w) {
  x = p[0], y = p[1], z = p[2], w = p[3];
}
POLHODE_INLINE void load3(const double* p, Wide& x, Wide& y, Wide& z) { x = p[0], y = p[1], z = p[2]; }
POLHODE_INLINE void store_bits(std::int64_t* to, Wide a) {
  *to = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(a.v) >> 46);
}

#endif

}  // namespace polhode::POLHODE_ISA
