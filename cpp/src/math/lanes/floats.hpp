#pragma once

#include <cstdint>
#include <cstring>

#include "math/lanes/scalar.hpp"

// Floats side by side in one register, twice as many as `Wide` has doubles; without AVX2 four. Each operation is one
// that IEEE 754 fixes: AVX2 and AVX-512 give the same bits. Each file that is built for one instruction set includes
// this after the header that defines `Wide`.
namespace polhode::POLHODE_ISA {

struct Floats {
#if defined(__AVX512F__)
  static constexpr int width = 16;
#elif defined(__AVX2__)
  static constexpr int width = 8;
#else
  static constexpr int width = 4;
#endif
  typedef float V __attribute__((vector_size(4 * width)));
  typedef std::int32_t Bits __attribute__((vector_size(4 * width)));

  V v;
  POLHODE_INLINE Floats() = default;
  POLHODE_INLINE Floats(V a) : v(a) {}                                // NOLINT(google-explicit-constructor)
  POLHODE_INLINE Floats(float a) : v(V{} + a) {}                      // NOLINT(google-explicit-constructor)
  POLHODE_INLINE Floats(double a) : Floats(static_cast<float>(a)) {}  // NOLINT(google-explicit-constructor)
  static POLHODE_INLINE Floats load(const float* p) {
    Floats a;
    std::memcpy(&a.v, p, sizeof a.v);
    return a;
  }
  POLHODE_INLINE void store(float* p) const { std::memcpy(p, &v, sizeof v); }
};

POLHODE_INLINE Floats operator+(Floats a, Floats b) { return a.v + b.v; }
POLHODE_INLINE Floats operator-(Floats a, Floats b) { return a.v - b.v; }
POLHODE_INLINE Floats operator*(Floats a, Floats b) { return a.v * b.v; }
POLHODE_INLINE Floats operator-(Floats a) { return -a.v; }
POLHODE_INLINE Floats madd(Floats a, Floats b, Floats c) {
#if defined(__AVX512F__)
  return static_cast<Floats::V>(_mm512_fmadd_ps(a.v, b.v, c.v));
#elif defined(__FMA__)
  return static_cast<Floats::V>(_mm256_fmadd_ps(a.v, b.v, c.v));
#else
  return a.v * b.v + c.v;
#endif
}

/// 1 / sqrt(a) of a normal number a > 0: a guess from the bits (3.4 %), a step of third order and one of Newton's.
POLHODE_INLINE Floats inverse_sqrt(Floats a) {
  Floats y(reinterpret_cast<Floats::V>(0x5f3759df - (reinterpret_cast<Floats::Bits>(a.v) >> 1)));
  const Floats rest = madd(-(a * y), y, Floats(1.0f));
  y = madd(y * rest, madd(Floats(0.375f), rest, Floats(0.5f)), y);
  return madd(y * Floats(0.5f), madd(-(a * y), y, Floats(1.0f)), y);
}

/// sin and cos of 2 pi f for |f| <= 1 within 1e-7. Polynomials: minimax on 1/8 turn (Remez exchange at 50 digits),
/// 2e-9 in exact arithmetic.
POLHODE_INLINE void sincos_cycles(Floats f, Floats& sine, Floats& cosine) {
  const Floats turns = f + Floats(0x1.8p21f);         // rounds f to quarters: the last bit of such numbers counts 1/4
  const Floats r = f - (turns - Floats(0x1.8p21f));   // exact
  const Floats y = r * r;
  const Floats s = madd(y, madd(y, Floats(-75.369648699550581), Floats(81.59198349114016)),
                        Floats(-41.341662558879206));
  const Floats c = madd(y, madd(y, madd(y, Floats(59.245963910844056), Floats(-85.443741720032691)),
                                Floats(64.939326471567418)), Floats(-19.739208693655421));
  const Floats sr = madd(r, Floats(6.283185307179586), r * madd(y, s, Floats(-1.7484556e-7)));
  const Floats cr = madd(y, c, Floats(1.0f));
  const Floats::Bits quarters = reinterpret_cast<Floats::Bits>(turns.v), sign = Floats::Bits{} + INT32_MIN;
  const Floats::Bits odd = (quarters & 1) != 0, second = quarters << 30;
  const auto with_sign = [](Floats::V x, Floats::Bits bits) __attribute__((always_inline)) {
    return reinterpret_cast<Floats::V>(reinterpret_cast<Floats::Bits>(x) ^ bits);
  };
  sine = with_sign(odd ? cr.v : sr.v, second & sign);
  cosine = with_sign(odd ? sr.v : cr.v, (second ^ (quarters << 31)) & sign);
}

#if defined(__AVX512F__)

POLHODE_INLINE void store_floats(float* p, Wide a) { _mm256_storeu_ps(p, _mm512_cvtpd_ps(a.v)); }

/// Rows of four numbers: pairs first, then two pairs together.
POLHODE_INLINE void store4(float* p, Floats x, Floats y, Floats z, Floats w) {
  const __m512i low = _mm512_setr_epi32(0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
  const __m512i high = _mm512_add_epi32(low, _mm512_set1_epi32(8));
  const __m512d xy0 = _mm512_castps_pd(_mm512_permutex2var_ps(x.v, low, y.v));
  const __m512d xy1 = _mm512_castps_pd(_mm512_permutex2var_ps(x.v, high, y.v));
  const __m512d zw0 = _mm512_castps_pd(_mm512_permutex2var_ps(z.v, low, w.v));
  const __m512d zw1 = _mm512_castps_pd(_mm512_permutex2var_ps(z.v, high, w.v));
  const __m512i first = _mm512_setr_epi64(0, 8, 1, 9, 2, 10, 3, 11);
  const __m512i last = _mm512_setr_epi64(4, 12, 5, 13, 6, 14, 7, 15);
  _mm512_storeu_ps(p, _mm512_castpd_ps(_mm512_permutex2var_pd(xy0, first, zw0)));
  _mm512_storeu_ps(p + 16, _mm512_castpd_ps(_mm512_permutex2var_pd(xy0, last, zw0)));
  _mm512_storeu_ps(p + 32, _mm512_castpd_ps(_mm512_permutex2var_pd(xy1, first, zw1)));
  _mm512_storeu_ps(p + 48, _mm512_castpd_ps(_mm512_permutex2var_pd(xy1, last, zw1)));
}

/// Rows of three numbers. Number c of row i goes to 3 i + c; modulo the width each of x, y, z takes every place once.
POLHODE_INLINE void store3(float* p, Floats x, Floats y, Floats z) {
  const __m512i to_x = _mm512_setr_epi32(0, 11, 6, 1, 12, 7, 2, 13, 8, 3, 14, 9, 4, 15, 10, 5);
  const __m512i to_y = _mm512_setr_epi32(5, 0, 11, 6, 1, 12, 7, 2, 13, 8, 3, 14, 9, 4, 15, 10);
  const __m512i to_z = _mm512_setr_epi32(10, 5, 0, 11, 6, 1, 12, 7, 2, 13, 8, 3, 14, 9, 4, 15);
  const __m512 a = _mm512_permutexvar_ps(to_x, x.v), b = _mm512_permutexvar_ps(to_y, y.v);
  const __m512 c = _mm512_permutexvar_ps(to_z, z.v);
  constexpr __mmask16 every_third = 0x9249;   // places 0, 3, 6, ..., 15
  constexpr __mmask16 from_1 = 0x2492, from_2 = 0x4924;
  const auto three = [](__m512 at0, __m512 at1, __m512 at2) __attribute__((always_inline)) {
    return _mm512_mask_blend_ps(from_2, _mm512_mask_blend_ps(from_1, at0, at1), at2);
  };
  static_assert((every_third ^ from_1 ^ from_2) == 0xffff);
  _mm512_storeu_ps(p, three(a, b, c));        // x at 0
  _mm512_storeu_ps(p + 16, three(b, c, a));   // 16 = 1 modulo 3
  _mm512_storeu_ps(p + 32, three(c, a, b));
}

#elif defined(__AVX2__)

POLHODE_INLINE void store_floats(float* p, Wide a) { _mm_storeu_ps(p, _mm256_cvtpd_ps(a.v)); }

/// Rows of four numbers.
POLHODE_INLINE void store4(float* p, Floats x, Floats y, Floats z, Floats w) {
  const __m256 a = _mm256_unpacklo_ps(x.v, y.v), b = _mm256_unpackhi_ps(x.v, y.v);
  const __m256 c = _mm256_unpacklo_ps(z.v, w.v), d = _mm256_unpackhi_ps(z.v, w.v);
  const __m256 row0 = _mm256_shuffle_ps(a, c, 0x44), row1 = _mm256_shuffle_ps(a, c, 0xee);   // and rows 4, 5
  const __m256 row2 = _mm256_shuffle_ps(b, d, 0x44), row3 = _mm256_shuffle_ps(b, d, 0xee);   // and rows 6, 7
  _mm256_storeu_ps(p, _mm256_permute2f128_ps(row0, row1, 0x20));
  _mm256_storeu_ps(p + 8, _mm256_permute2f128_ps(row2, row3, 0x20));
  _mm256_storeu_ps(p + 16, _mm256_permute2f128_ps(row0, row1, 0x31));
  _mm256_storeu_ps(p + 24, _mm256_permute2f128_ps(row2, row3, 0x31));
}

/// Rows of three numbers. Number c of row i goes to 3 i + c; modulo the width each of x, y, z takes every place once.
POLHODE_INLINE void store3(float* p, Floats x, Floats y, Floats z) {
  const __m256 a = _mm256_permutevar8x32_ps(x.v, _mm256_setr_epi32(0, 3, 6, 1, 4, 7, 2, 5));
  const __m256 b = _mm256_permutevar8x32_ps(y.v, _mm256_setr_epi32(5, 0, 3, 6, 1, 4, 7, 2));
  const __m256 c = _mm256_permutevar8x32_ps(z.v, _mm256_setr_epi32(2, 5, 0, 3, 6, 1, 4, 7));
  const auto three = [](__m256 at0, __m256 at1, __m256 at2) __attribute__((always_inline)) {
    return _mm256_blend_ps(_mm256_blend_ps(at0, at1, 0x92), at2, 0x24);
  };
  _mm256_storeu_ps(p, three(a, b, c));        // x at 0
  _mm256_storeu_ps(p + 8, three(c, a, b));    // 8 = 2 modulo 3
  _mm256_storeu_ps(p + 16, three(b, c, a));
}

#else

POLHODE_INLINE void store_floats(float* p, Wide a) { *p = static_cast<float>(a.v); }
POLHODE_INLINE void store4(float* p, Floats x, Floats y, Floats z, Floats w) {
  for (int i = 0; i < Floats::width; ++i)
    p[4 * i] = x.v[i], p[4 * i + 1] = y.v[i], p[4 * i + 2] = z.v[i], p[4 * i + 3] = w.v[i];
}
POLHODE_INLINE void store3(float* p, Floats x, Floats y, Floats z) {
  for (int i = 0; i < Floats::width; ++i) p[3 * i] = x.v[i], p[3 * i + 1] = y.v[i], p[3 * i + 2] = z.v[i];
}

#endif

}  // namespace polhode::POLHODE_ISA
