#pragma once

#include "polhode/math/detail/number.hpp"

#if defined(__AVX2__)
#include <immintrin.h>
#endif

// Four and eight doubles that belong to one body: its components side by side, for the instruction set of the file.
// POLHODE_ISA names the namespace. Sums run in one order at every level, so that avx2 and avx512 give the same bits.
namespace polhode::POLHODE_ISA {

#if defined(__AVX2__)

struct Quad {
  __m256d v;
};
POLHODE_INLINE Quad load4(const double* p) { return {_mm256_loadu_pd(p)}; }
POLHODE_INLINE void store4(double* p, Quad a) { _mm256_storeu_pd(p, a.v); }
POLHODE_INLINE Quad all4(double a) { return {_mm256_set1_pd(a)}; }
POLHODE_INLINE Quad set4(double a, double b, double c, double d) { return {_mm256_setr_pd(a, b, c, d)}; }
POLHODE_INLINE Quad operator+(Quad a, Quad b) { return {_mm256_add_pd(a.v, b.v)}; }
POLHODE_INLINE Quad operator-(Quad a, Quad b) { return {_mm256_sub_pd(a.v, b.v)}; }
POLHODE_INLINE Quad operator*(Quad a, Quad b) { return {_mm256_mul_pd(a.v, b.v)}; }
POLHODE_INLINE Quad operator/(Quad a, Quad b) { return {_mm256_div_pd(a.v, b.v)}; }
POLHODE_INLINE Quad operator^(Quad a, Quad signs) { return {_mm256_xor_pd(a.v, signs.v)}; }
POLHODE_INLINE Quad madd(Quad a, Quad b, Quad c) { return {_mm256_fmadd_pd(a.v, b.v, c.v)}; }
template <int a, int b, int c, int d>
POLHODE_INLINE Quad permute(Quad q) {
  return {_mm256_permute4x64_pd(q.v, a | b << 2 | c << 4 | d << 6)};
}
/// Lanes of `b` where the bit of `mask` is set, else of `a`.
template <int mask>
POLHODE_INLINE Quad blend(Quad a, Quad b) {
  return {_mm256_blend_pd(a.v, b.v, mask)};
}

#else

// Two registers of 128 bits, which every processor of today has. GCC splits longer vectors badly.
struct Quad {
  typedef double Vector __attribute__((vector_size(16)));
  typedef long long Bits __attribute__((vector_size(16)));
  typedef double Stored __attribute__((vector_size(16), aligned(8), may_alias));   // memory that is read as doubles too
  Vector front, back;
};
POLHODE_INLINE Quad set4(double a, double b, double c, double d) { return {Quad::Vector{a, b}, Quad::Vector{c, d}}; }
POLHODE_INLINE Quad all4(double a) { return set4(a, a, a, a); }
POLHODE_INLINE Quad load4(const double* p) {
  return {*reinterpret_cast<const Quad::Stored*>(p), *reinterpret_cast<const Quad::Stored*>(p + 2)};
}
POLHODE_INLINE void store4(double* p, Quad a) {
  *reinterpret_cast<Quad::Stored*>(p) = a.front, *reinterpret_cast<Quad::Stored*>(p + 2) = a.back;
}
POLHODE_INLINE Quad operator+(Quad a, Quad b) { return {a.front + b.front, a.back + b.back}; }
POLHODE_INLINE Quad operator-(Quad a, Quad b) { return {a.front - b.front, a.back - b.back}; }
POLHODE_INLINE Quad operator*(Quad a, Quad b) { return {a.front * b.front, a.back * b.back}; }
POLHODE_INLINE Quad operator/(Quad a, Quad b) { return {a.front / b.front, a.back / b.back}; }
POLHODE_INLINE Quad::Vector flip(Quad::Vector a, Quad::Vector signs) {
  return reinterpret_cast<Quad::Vector>(reinterpret_cast<Quad::Bits>(a) ^ reinterpret_cast<Quad::Bits>(signs));
}
POLHODE_INLINE Quad operator^(Quad a, Quad signs) { return {flip(a.front, signs.front), flip(a.back, signs.back)}; }
POLHODE_INLINE Quad madd(Quad a, Quad b, Quad c) { return a * b + c; }
template <int a, int b, int c, int d>
POLHODE_INLINE Quad permute(Quad q) {
  return {__builtin_shufflevector(q.front, q.back, a, b), __builtin_shufflevector(q.front, q.back, c, d)};
}
template <int mask>
POLHODE_INLINE Quad blend(Quad a, Quad b) {
  return {__builtin_shufflevector(a.front, b.front, mask & 1 ? 2 : 0, mask & 2 ? 3 : 1),
          __builtin_shufflevector(a.back, b.back, mask & 4 ? 2 : 0, mask & 8 ? 3 : 1)};
}

#endif

#if defined(__AVX512DQ__)

constexpr int octets_at_once = 8;   ///< of which sums of products may be under way without leaving the registers
struct Octet {
  __m512d v;
};
POLHODE_INLINE Octet load8(const double* p) { return {_mm512_loadu_pd(p)}; }
POLHODE_INLINE void store8(double* p, Octet a) { _mm512_storeu_pd(p, a.v); }
POLHODE_INLINE Octet all8(double a) { return {_mm512_set1_pd(a)}; }
POLHODE_INLINE Octet operator+(Octet a, Octet b) { return {_mm512_add_pd(a.v, b.v)}; }
POLHODE_INLINE Octet operator*(Octet a, Octet b) { return {_mm512_mul_pd(a.v, b.v)}; }
POLHODE_INLINE Octet operator^(Octet a, Octet signs) { return {_mm512_xor_pd(a.v, signs.v)}; }
POLHODE_INLINE Octet madd(Octet a, Octet b, Octet c) { return {_mm512_fmadd_pd(a.v, b.v, c.v)}; }
POLHODE_INLINE Quad low(Octet a) { return {_mm512_castpd512_pd256(a.v)}; }
POLHODE_INLINE Quad high(Octet a) { return {_mm512_extractf64x4_pd(a.v, 1)}; }
POLHODE_INLINE Octet join(Quad a, Quad b) { return {_mm512_insertf64x4(_mm512_castpd256_pd512(a.v), b.v, 1)}; }
template <int a, int b, int c, int d, int e, int f, int g, int h>
POLHODE_INLINE Octet spread(Quad q) {
  return {_mm512_permutexvar_pd(_mm512_setr_epi64(a, b, c, d, e, f, g, h), _mm512_castpd256_pd512(q.v))};
}

#else

#if defined(__AVX2__)
constexpr int octets_at_once = 2;
#else
constexpr int octets_at_once = 1;
#endif
struct Octet {
  Quad a, b;
};
POLHODE_INLINE Octet load8(const double* p) { return {load4(p), load4(p + 4)}; }
POLHODE_INLINE void store8(double* p, Octet o) { store4(p, o.a), store4(p + 4, o.b); }
POLHODE_INLINE Octet all8(double a) { return {all4(a), all4(a)}; }
POLHODE_INLINE Octet operator+(Octet a, Octet b) { return {a.a + b.a, a.b + b.b}; }
POLHODE_INLINE Octet operator*(Octet a, Octet b) { return {a.a * b.a, a.b * b.b}; }
POLHODE_INLINE Octet operator^(Octet a, Octet signs) { return {a.a ^ signs.a, a.b ^ signs.b}; }
POLHODE_INLINE Octet madd(Octet a, Octet b, Octet c) { return {madd(a.a, b.a, c.a), madd(a.b, b.b, c.b)}; }
POLHODE_INLINE Quad low(Octet o) { return o.a; }
POLHODE_INLINE Quad high(Octet o) { return o.b; }
POLHODE_INLINE Octet join(Quad a, Quad b) { return {a, b}; }
template <int a, int b, int c, int d, int e, int f, int g, int h>
POLHODE_INLINE Octet spread(Quad q) {
  return {permute<a, b, c, d>(q), permute<e, f, g, h>(q)};
}

#endif

}  // namespace polhode::POLHODE_ISA
