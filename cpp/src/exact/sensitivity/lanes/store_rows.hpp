#pragma once

#include "math/lanes/scalar.hpp"

// Rows of an even count of numbers, transposed from one vector for each number.
namespace polhode::POLHODE_ISA {

template <int count>
POLHODE_INLINE void store_rows(double* p, const One (&v)[count]) {
  for (int k = 0; k < count; ++k) p[k] = v[k].v;
}

#ifdef __AVX512DQ__

/// Eight rows of eight numbers, `stride` apart.
POLHODE_INLINE void store_block8(double* p, int stride, const Wide* v) {
  __m512d a[8], b[8];
  for (int i = 0; i < 8; i += 2) {
    a[i] = _mm512_unpacklo_pd(v[i].v, v[i + 1].v);
    a[i + 1] = _mm512_unpackhi_pd(v[i].v, v[i + 1].v);
  }
  // Lanes of 128 bits: a[i] holds rows 0, 2, 4, 6 of two numbers, a[i + 1] the odd rows.
  for (int i = 0; i < 8; i += 4) {
    for (int k = 0; k < 2; ++k) {
      b[i + k] = _mm512_shuffle_f64x2(a[i + k], a[i + 2 + k], 0x88);      // rows k, k + 4
      b[i + 2 + k] = _mm512_shuffle_f64x2(a[i + k], a[i + 2 + k], 0xdd);  // rows k + 2, k + 6
    }
  }
  for (int k = 0; k < 4; ++k) {
    _mm512_storeu_pd(p + k * stride, _mm512_shuffle_f64x2(b[k], b[4 + k], 0x88));
    _mm512_storeu_pd(p + (k + 4) * stride, _mm512_shuffle_f64x2(b[k], b[4 + k], 0xdd));
  }
}

/// Eight rows of two numbers.
POLHODE_INLINE void store_block2(double* p, int stride, const Wide* v) {
  const __m512d even = _mm512_unpacklo_pd(v[0].v, v[1].v), odd = _mm512_unpackhi_pd(v[0].v, v[1].v);
  _mm_storeu_pd(p, _mm512_castpd512_pd128(even)), _mm_storeu_pd(p + stride, _mm512_castpd512_pd128(odd));
  _mm_storeu_pd(p + 2 * stride, _mm512_extractf64x2_pd(even, 1));
  _mm_storeu_pd(p + 3 * stride, _mm512_extractf64x2_pd(odd, 1));
  _mm_storeu_pd(p + 4 * stride, _mm512_extractf64x2_pd(even, 2));
  _mm_storeu_pd(p + 5 * stride, _mm512_extractf64x2_pd(odd, 2));
  _mm_storeu_pd(p + 6 * stride, _mm512_extractf64x2_pd(even, 3));
  _mm_storeu_pd(p + 7 * stride, _mm512_extractf64x2_pd(odd, 3));
}

#elif defined(__AVX2__)

/// Four rows of four numbers.
POLHODE_INLINE void store_block4(double* p, int stride, const Wide* v) {
  const __m256d a = _mm256_unpacklo_pd(v[0].v, v[1].v), b = _mm256_unpackhi_pd(v[0].v, v[1].v);
  const __m256d c = _mm256_unpacklo_pd(v[2].v, v[3].v), d = _mm256_unpackhi_pd(v[2].v, v[3].v);
  _mm256_storeu_pd(p, _mm256_permute2f128_pd(a, c, 0x20));
  _mm256_storeu_pd(p + stride, _mm256_permute2f128_pd(b, d, 0x20));
  _mm256_storeu_pd(p + 2 * stride, _mm256_permute2f128_pd(a, c, 0x31));
  _mm256_storeu_pd(p + 3 * stride, _mm256_permute2f128_pd(b, d, 0x31));
}

POLHODE_INLINE void store_block8(double* p, int stride, const Wide* v) {
  store_block4(p, stride, v), store_block4(p + 4, stride, v + 4);
}

/// Four rows of two numbers.
POLHODE_INLINE void store_block2(double* p, int stride, const Wide* v) {
  const __m256d even = _mm256_unpacklo_pd(v[0].v, v[1].v), odd = _mm256_unpackhi_pd(v[0].v, v[1].v);
  _mm_storeu_pd(p, _mm256_castpd256_pd128(even)), _mm_storeu_pd(p + stride, _mm256_castpd256_pd128(odd));
  _mm_storeu_pd(p + 2 * stride, _mm256_extractf128_pd(even, 1));
  _mm_storeu_pd(p + 3 * stride, _mm256_extractf128_pd(odd, 1));
}

#endif
#ifdef __AVX2__

template <int count>
POLHODE_INLINE void store_rows(double* p, const Wide (&v)[count]) {
  static_assert(count % 8 == 0 || count % 8 == 2);
  for (int k = 0; k + 8 <= count; k += 8) store_block8(p + k, count, v + k);
  if (count % 8 == 2) store_block2(p + count - 2, count, v + count - 2);
}

#endif

}  // namespace polhode::POLHODE_ISA
