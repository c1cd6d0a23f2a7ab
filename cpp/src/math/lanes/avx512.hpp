#pragma once

#include <immintrin.h>

#include "polhode/math/detail/double_double.hpp"

namespace polhode::POLHODE_ISA {

/// Eight doubles in one register.
struct Wide {
  static constexpr int width = 8;
  __m512d v;
  POLHODE_INLINE Wide() = default;
  POLHODE_INLINE Wide(__m512d a) : v(a) {}               // NOLINT(google-explicit-constructor)
  POLHODE_INLINE Wide(double a) : v(_mm512_set1_pd(a)) {}  // NOLINT(google-explicit-constructor)
  static POLHODE_INLINE Wide load(const double* p) { return _mm512_loadu_pd(p); }
  POLHODE_INLINE void store(double* p) const { _mm512_storeu_pd(p, v); }
};

struct WideMask {
  __mmask8 m;
};
POLHODE_INLINE WideMask operator&(WideMask a, WideMask b) { return {static_cast<__mmask8>(a.m & b.m)}; }
POLHODE_INLINE WideMask operator|(WideMask a, WideMask b) { return {static_cast<__mmask8>(a.m | b.m)}; }
POLHODE_INLINE unsigned bits(WideMask a) { return a.m; }

POLHODE_INLINE Wide operator+(Wide a, Wide b) { return _mm512_add_pd(a.v, b.v); }
POLHODE_INLINE Wide operator-(Wide a, Wide b) { return _mm512_sub_pd(a.v, b.v); }
POLHODE_INLINE Wide operator*(Wide a, Wide b) { return _mm512_mul_pd(a.v, b.v); }
POLHODE_INLINE Wide operator/(Wide a, Wide b) { return _mm512_div_pd(a.v, b.v); }
POLHODE_INLINE Wide operator-(Wide a) { return -a.v; }  // the compiler makes it part of a fused multiply-add
POLHODE_INLINE WideMask operator<(Wide a, Wide b) { return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_LT_OQ)}; }
POLHODE_INLINE WideMask operator>(Wide a, Wide b) { return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_GT_OQ)}; }
POLHODE_INLINE WideMask operator<=(Wide a, Wide b) { return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_LE_OQ)}; }
POLHODE_INLINE WideMask operator==(Wide a, Wide b) { return {_mm512_cmp_pd_mask(a.v, b.v, _CMP_EQ_OQ)}; }
POLHODE_INLINE Wide select(WideMask k, Wide a, Wide b) { return _mm512_mask_blend_pd(k.m, b.v, a.v); }
POLHODE_INLINE Wide fma(Wide a, Wide b, Wide c) { return _mm512_fmadd_pd(a.v, b.v, c.v); }
POLHODE_INLINE Wide madd(Wide a, Wide b, Wide c) { return _mm512_fmadd_pd(a.v, b.v, c.v); }
POLHODE_INLINE Wide rint(Wide a) { return _mm512_roundscale_pd(a.v, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC); }
POLHODE_INLINE Wide sqrt(Wide a) { return _mm512_sqrt_pd(a.v); }
POLHODE_INLINE Wide abs(Wide a) { return _mm512_andnot_pd(_mm512_set1_pd(-0.0), a.v); }
/// The larger; for NaN, either.
POLHODE_INLINE Wide larger(Wide a, Wide b) { return _mm512_max_pd(a.v, b.v); }
POLHODE_INLINE Wide copysign(Wide a, Wide b) {
  const __m512d sign = _mm512_set1_pd(-0.0);
  return _mm512_or_pd(_mm512_andnot_pd(sign, a.v), _mm512_and_pd(sign, b.v));
}
POLHODE_INLINE Wide power_of_two(Wide n) {
  const __m512d biased = _mm512_add_pd(n.v, _mm512_set1_pd(0x1.8p52 + 1023.0));
  return _mm512_castsi512_pd(_mm512_slli_epi64(_mm512_castpd_si512(biased), 52));
}
POLHODE_INLINE Wide power_of_two_below(Wide a) {
  const __m512d exponent = _mm512_castsi512_pd(_mm512_set1_epi64(0x7ff0000000000000));
  return _mm512_max_pd(_mm512_and_pd(a.v, exponent), _mm512_set1_pd(0x1p-1022));
}
POLHODE_INLINE Wide exponent_of_power(Wide a) {
  // The exponent field as an integer below 2^52: put into the mantissa of 2^52, then 2^52 taken away.
  const __m512i field = _mm512_srli_epi64(_mm512_castpd_si512(a.v), 52);
  const __m512d shifted = _mm512_castsi512_pd(_mm512_or_si512(field, _mm512_set1_epi64(0x4330000000000000)));
  return _mm512_sub_pd(shifted, _mm512_set1_pd(0x1p52 + 1023.0));
}
POLHODE_INLINE Wide guess_inverse_sqrt(Wide a) {
  const __m512i half = _mm512_srli_epi64(_mm512_castpd_si512(a.v), 1);
  return _mm512_castsi512_pd(_mm512_sub_epi64(_mm512_set1_epi64(0x5fe6eb50c7b537a9), half));
}
POLHODE_INLINE void add_quarters(Wide turns, Wide sin_r, Wide cos_r, Wide& sine, Wide& cosine) {
  const __m512i bits = _mm512_castpd_si512(turns.v), sign = _mm512_set1_epi64(INT64_MIN);
  const __mmask8 odd = _mm512_test_epi64_mask(bits, _mm512_set1_epi64(1));
  const __m512i second = _mm512_slli_epi64(bits, 62), either = _mm512_xor_si512(second, _mm512_slli_epi64(bits, 63));
  const __m512i s = _mm512_castpd_si512(_mm512_mask_blend_pd(odd, sin_r.v, cos_r.v));
  const __m512i c = _mm512_castpd_si512(_mm512_mask_blend_pd(odd, cos_r.v, sin_r.v));
  sine = _mm512_castsi512_pd(_mm512_xor_si512(s, _mm512_and_si512(second, sign)));
  cosine = _mm512_castsi512_pd(_mm512_xor_si512(c, _mm512_and_si512(either, sign)));
}

/// Rows x0 y0 z0 w0 x1 ... of four numbers.
POLHODE_INLINE void store4(double* p, Wide x, Wide y, Wide z, Wide w) {
  const __m512d a = _mm512_unpacklo_pd(x.v, y.v), b = _mm512_unpackhi_pd(x.v, y.v);
  const __m512d c = _mm512_unpacklo_pd(z.v, w.v), d = _mm512_unpackhi_pd(z.v, w.v);
  const __m512i low = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11), high = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
  const __m512d e = _mm512_permutex2var_pd(a, low, c), f = _mm512_permutex2var_pd(b, low, d);
  const __m512d g = _mm512_permutex2var_pd(a, high, c), h = _mm512_permutex2var_pd(b, high, d);
  _mm512_storeu_pd(p, _mm512_shuffle_f64x2(e, f, 0x44));
  _mm512_storeu_pd(p + 8, _mm512_shuffle_f64x2(e, f, 0xee));
  _mm512_storeu_pd(p + 16, _mm512_shuffle_f64x2(g, h, 0x44));
  _mm512_storeu_pd(p + 24, _mm512_shuffle_f64x2(g, h, 0xee));
}

/// Rows of three numbers.
POLHODE_INLINE void store3(double* p, Wide x, Wide y, Wide z) {
  // Three registers of the 24 numbers, each from x and y first, then z put in.
  const __m512d p0 = _mm512_permutex2var_pd(x.v, _mm512_setr_epi64(0, 8, 0, 1, 9, 0, 2, 10), y.v);
  const __m512d p1 = _mm512_permutex2var_pd(x.v, _mm512_setr_epi64(0, 3, 11, 0, 4, 12, 0, 5), y.v);
  const __m512d p2 = _mm512_permutex2var_pd(x.v, _mm512_setr_epi64(13, 0, 6, 14, 0, 7, 15, 0), y.v);
  _mm512_storeu_pd(p, _mm512_permutex2var_pd(p0, _mm512_setr_epi64(0, 1, 8, 3, 4, 9, 6, 7), z.v));
  _mm512_storeu_pd(p + 8, _mm512_permutex2var_pd(p1, _mm512_setr_epi64(10, 1, 2, 11, 4, 5, 12, 7), z.v));
  _mm512_storeu_pd(p + 16, _mm512_permutex2var_pd(p2, _mm512_setr_epi64(0, 13, 2, 3, 14, 5, 6, 15), z.v));
}

/// The columns of rows of three and of four numbers: store3 and store4 undone.
POLHODE_INLINE void load3(const double* p, Wide& x, Wide& y, Wide& z) {
  const __m512d a = _mm512_loadu_pd(p), b = _mm512_loadu_pd(p + 8), c = _mm512_loadu_pd(p + 16);
  const __m512d x0 = _mm512_permutex2var_pd(a, _mm512_setr_epi64(0, 3, 6, 9, 12, 15, 0, 0), b);
  const __m512d y0 = _mm512_permutex2var_pd(a, _mm512_setr_epi64(1, 4, 7, 10, 13, 0, 0, 0), b);
  const __m512d z0 = _mm512_permutex2var_pd(a, _mm512_setr_epi64(2, 5, 8, 11, 14, 0, 0, 0), b);
  x = _mm512_permutex2var_pd(x0, _mm512_setr_epi64(0, 1, 2, 3, 4, 5, 10, 13), c);
  y = _mm512_permutex2var_pd(y0, _mm512_setr_epi64(0, 1, 2, 3, 4, 8, 11, 14), c);
  z = _mm512_permutex2var_pd(z0, _mm512_setr_epi64(0, 1, 2, 3, 4, 9, 12, 15), c);
}
POLHODE_INLINE void load4(const double* p, Wide& x, Wide& y, Wide& z, Wide& w) {
  const __m512i xy = _mm512_setr_epi64(0, 4, 8, 12, 1, 5, 9, 13), zw = _mm512_setr_epi64(2, 6, 10, 14, 3, 7, 11, 15);
  const __m512d a = _mm512_loadu_pd(p), b = _mm512_loadu_pd(p + 8);
  const __m512d c = _mm512_loadu_pd(p + 16), d = _mm512_loadu_pd(p + 24);
  const __m512d xy0 = _mm512_permutex2var_pd(a, xy, b), xy1 = _mm512_permutex2var_pd(c, xy, d);
  const __m512d zw0 = _mm512_permutex2var_pd(a, zw, b), zw1 = _mm512_permutex2var_pd(c, zw, d);
  x = _mm512_shuffle_f64x2(xy0, xy1, 0x44), y = _mm512_shuffle_f64x2(xy0, xy1, 0xee);
  z = _mm512_shuffle_f64x2(zw0, zw1, 0x44), w = _mm512_shuffle_f64x2(zw0, zw1, 0xee);
}

}  // namespace polhode::POLHODE_ISA
