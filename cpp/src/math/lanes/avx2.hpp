#pragma once

#include <immintrin.h>

#include "polhode/math/detail/double_double.hpp"

namespace polhode::POLHODE_ISA {

/// Four doubles in one register.
struct Wide {
  static constexpr int width = 4;
  __m256d v;
  POLHODE_INLINE Wide() = default;
  POLHODE_INLINE Wide(__m256d a) : v(a) {}               // NOLINT(google-explicit-constructor)
  POLHODE_INLINE Wide(double a) : v(_mm256_set1_pd(a)) {}  // NOLINT(google-explicit-constructor)
  static POLHODE_INLINE Wide load(const double* p) { return _mm256_loadu_pd(p); }
  POLHODE_INLINE void store(double* p) const { _mm256_storeu_pd(p, v); }
};

struct WideMask {
  __m256d m;
};
POLHODE_INLINE WideMask operator&(WideMask a, WideMask b) { return {_mm256_and_pd(a.m, b.m)}; }
POLHODE_INLINE WideMask operator|(WideMask a, WideMask b) { return {_mm256_or_pd(a.m, b.m)}; }
POLHODE_INLINE unsigned bits(WideMask a) { return static_cast<unsigned>(_mm256_movemask_pd(a.m)); }

POLHODE_INLINE Wide operator+(Wide a, Wide b) { return _mm256_add_pd(a.v, b.v); }
POLHODE_INLINE Wide operator-(Wide a, Wide b) { return _mm256_sub_pd(a.v, b.v); }
POLHODE_INLINE Wide operator*(Wide a, Wide b) { return _mm256_mul_pd(a.v, b.v); }
POLHODE_INLINE Wide operator/(Wide a, Wide b) { return _mm256_div_pd(a.v, b.v); }
POLHODE_INLINE Wide operator-(Wide a) { return -a.v; }  // the compiler makes it part of a fused multiply-add
POLHODE_INLINE WideMask operator<(Wide a, Wide b) { return {_mm256_cmp_pd(a.v, b.v, _CMP_LT_OQ)}; }
POLHODE_INLINE WideMask operator>(Wide a, Wide b) { return {_mm256_cmp_pd(a.v, b.v, _CMP_GT_OQ)}; }
POLHODE_INLINE WideMask operator<=(Wide a, Wide b) { return {_mm256_cmp_pd(a.v, b.v, _CMP_LE_OQ)}; }
POLHODE_INLINE WideMask operator==(Wide a, Wide b) { return {_mm256_cmp_pd(a.v, b.v, _CMP_EQ_OQ)}; }
POLHODE_INLINE Wide select(WideMask k, Wide a, Wide b) { return _mm256_blendv_pd(b.v, a.v, k.m); }
POLHODE_INLINE Wide fma(Wide a, Wide b, Wide c) { return _mm256_fmadd_pd(a.v, b.v, c.v); }
POLHODE_INLINE Wide madd(Wide a, Wide b, Wide c) { return _mm256_fmadd_pd(a.v, b.v, c.v); }
POLHODE_INLINE Wide rint(Wide a) { return _mm256_round_pd(a.v, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC); }
POLHODE_INLINE Wide sqrt(Wide a) { return _mm256_sqrt_pd(a.v); }
POLHODE_INLINE Wide abs(Wide a) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a.v); }
/// The larger; for NaN, either.
POLHODE_INLINE Wide larger(Wide a, Wide b) { return _mm256_max_pd(a.v, b.v); }
POLHODE_INLINE Wide copysign(Wide a, Wide b) {
  const __m256d sign = _mm256_set1_pd(-0.0);
  return _mm256_or_pd(_mm256_andnot_pd(sign, a.v), _mm256_and_pd(sign, b.v));
}
POLHODE_INLINE Wide power_of_two(Wide n) {
  const __m256d biased = _mm256_add_pd(n.v, _mm256_set1_pd(0x1.8p52 + 1023.0));
  return _mm256_castsi256_pd(_mm256_slli_epi64(_mm256_castpd_si256(biased), 52));
}
POLHODE_INLINE Wide power_of_two_below(Wide a) {
  const __m256d exponent = _mm256_castsi256_pd(_mm256_set1_epi64x(0x7ff0000000000000));
  return _mm256_max_pd(_mm256_and_pd(a.v, exponent), _mm256_set1_pd(0x1p-1022));
}
POLHODE_INLINE Wide exponent_of_power(Wide a) {
  // The exponent field as an integer below 2^52: put into the mantissa of 2^52, then 2^52 taken away.
  const __m256i field = _mm256_srli_epi64(_mm256_castpd_si256(a.v), 52);
  const __m256d shifted = _mm256_castsi256_pd(_mm256_or_si256(field, _mm256_set1_epi64x(0x4330000000000000)));
  return _mm256_sub_pd(shifted, _mm256_set1_pd(0x1p52 + 1023.0));
}
POLHODE_INLINE Wide guess_inverse_sqrt(Wide a) {
  const __m256i half = _mm256_srli_epi64(_mm256_castpd_si256(a.v), 1);
  return _mm256_castsi256_pd(_mm256_sub_epi64(_mm256_set1_epi64x(0x5fe6eb50c7b537a9), half));
}
POLHODE_INLINE void add_quarters(Wide turns, Wide sin_r, Wide cos_r, Wide& sine, Wide& cosine) {
  const __m256i bits = _mm256_castpd_si256(turns.v), second = _mm256_slli_epi64(bits, 62);
  const __m256d first = _mm256_castsi256_pd(_mm256_slli_epi64(bits, 63)), sign = _mm256_set1_pd(-0.0);
  const __m256d sine_sign = _mm256_and_pd(_mm256_castsi256_pd(second), sign);
  sine = _mm256_xor_pd(_mm256_blendv_pd(sin_r.v, cos_r.v, first), sine_sign);
  cosine = _mm256_xor_pd(_mm256_blendv_pd(cos_r.v, sin_r.v, first), _mm256_xor_pd(sine_sign, first));
}

/// Rows x0 y0 z0 w0 x1 ... of four numbers.
POLHODE_INLINE void store4(double* p, Wide x, Wide y, Wide z, Wide w) {
  const __m256d a = _mm256_unpacklo_pd(x.v, y.v), b = _mm256_unpackhi_pd(x.v, y.v);
  const __m256d c = _mm256_unpacklo_pd(z.v, w.v), d = _mm256_unpackhi_pd(z.v, w.v);
  _mm256_storeu_pd(p, _mm256_permute2f128_pd(a, c, 0x20));
  _mm256_storeu_pd(p + 4, _mm256_permute2f128_pd(b, d, 0x20));
  _mm256_storeu_pd(p + 8, _mm256_permute2f128_pd(a, c, 0x31));
  _mm256_storeu_pd(p + 12, _mm256_permute2f128_pd(b, d, 0x31));
}

/// Rows of three numbers.
POLHODE_INLINE void store3(double* p, Wide x, Wide y, Wide z) {
  const __m256d xy = _mm256_unpacklo_pd(x.v, y.v);             // x0 y0 x2 y2
  const __m256d yz = _mm256_unpackhi_pd(y.v, z.v);             // y1 z1 y3 z3
  const __m256d zx = _mm256_shuffle_pd(z.v, x.v, 0b1010);      // z0 x1 z2 x3
  _mm256_storeu_pd(p, _mm256_permute2f128_pd(xy, zx, 0x20));       // x0 y0 z0 x1
  _mm256_storeu_pd(p + 4, _mm256_permute2f128_pd(yz, xy, 0x30));   // y1 z1 x2 y2
  _mm256_storeu_pd(p + 8, _mm256_permute2f128_pd(zx, yz, 0x31));   // z2 x3 y3 z3
}

/// The columns of rows of three and of four numbers: store3 and store4 undone.
POLHODE_INLINE void load3(const double* p, Wide& x, Wide& y, Wide& z) {
  const __m256d a = _mm256_loadu_pd(p), b = _mm256_loadu_pd(p + 4), c = _mm256_loadu_pd(p + 8);
  const __m256d xy = _mm256_permute2f128_pd(a, b, 0x30), zx = _mm256_permute2f128_pd(a, c, 0x21),
                yz = _mm256_permute2f128_pd(b, c, 0x30);
  x = _mm256_shuffle_pd(xy, zx, 0b1010), y = _mm256_shuffle_pd(xy, yz, 0b0101), z = _mm256_shuffle_pd(zx, yz, 0b1010);
}
POLHODE_INLINE void load4(const double* p, Wide& x, Wide& y, Wide& z, Wide& w) {
  const __m256d a = _mm256_loadu_pd(p), b = _mm256_loadu_pd(p + 4);
  const __m256d c = _mm256_loadu_pd(p + 8), d = _mm256_loadu_pd(p + 12);
  const __m256d xz0 = _mm256_unpacklo_pd(a, b), yw0 = _mm256_unpackhi_pd(a, b);
  const __m256d xz1 = _mm256_unpacklo_pd(c, d), yw1 = _mm256_unpackhi_pd(c, d);
  x = _mm256_permute2f128_pd(xz0, xz1, 0x20), z = _mm256_permute2f128_pd(xz0, xz1, 0x31);
  y = _mm256_permute2f128_pd(yw0, yw1, 0x20), w = _mm256_permute2f128_pd(yw0, yw1, 0x31);
}

}  // namespace polhode::POLHODE_ISA
