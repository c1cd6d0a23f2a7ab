#pragma once

#include "polhode/formula/table.hpp"
#include "polhode/math/detail/number.hpp"

#if defined(__AVX2__)
#include <immintrin.h>
#endif

#if defined(__GNUC__) || defined(__clang__)
#define POLHODE_LAMBDA __attribute__((always_inline))
#else
#define POLHODE_LAMBDA
#endif

// Eight numbers as one register of 512 bits, two of 256 or four of 128. POLHODE_ISA names the namespace.
namespace polhode::formula::POLHODE_ISA {

#if defined(__AVX512DQ__)

constexpr int octets_at_once = 2;   ///< whose sums of two rows are under way at a time, by measurement
struct Octet {
  __m512d v;
};
POLHODE_INLINE Octet load(const double* p) { return {_mm512_load_pd(p)}; }
POLHODE_INLINE void store(double* p, Octet a) { _mm512_store_pd(p, a.v); }
POLHODE_INLINE Octet all(double a) { return {_mm512_set1_pd(a)}; }
POLHODE_INLINE Octet operator+(Octet a, Octet b) { return {_mm512_add_pd(a.v, b.v)}; }
POLHODE_INLINE Octet operator*(Octet a, Octet b) { return {_mm512_mul_pd(a.v, b.v)}; }
POLHODE_INLINE Octet operator/(Octet a, Octet b) { return {_mm512_div_pd(a.v, b.v)}; }
POLHODE_INLINE Octet madd(Octet a, Octet b, Octet c) { return {_mm512_fmadd_pd(a.v, b.v, c.v)}; }
POLHODE_INLINE Octet take(const double* values, const Pick& pick) {
  return {_mm512_permutex2var_pd(_mm512_load_pd(values + pick.first), _mm512_load_si512(pick.index.data()),
                                 _mm512_load_pd(values + pick.second))};
}
/// An octet of operands from any lanes.
POLHODE_INLINE Octet gather(const double* values, const Pick* picks, Range range) {
  Octet found = take(values, picks[range.begin]);
  for (std::ptrdiff_t i = range.begin + 1; i < range.end; ++i)
    found.v = _mm512_mask_mov_pd(found.v, static_cast<__mmask8>(picks[i].mask), take(values, picks[i]).v);
  return found;
}

#else

#if defined(__AVX2__)

constexpr int octets_at_once = 1;
struct Part {
  __m256d v;
};
POLHODE_INLINE Part load_part(const double* p) { return {_mm256_load_pd(p)}; }
POLHODE_INLINE void store_part(double* p, Part a) { _mm256_store_pd(p, a.v); }
POLHODE_INLINE Part all_part(double a) { return {_mm256_set1_pd(a)}; }
POLHODE_INLINE Part add(Part a, Part b) { return {_mm256_add_pd(a.v, b.v)}; }
POLHODE_INLINE Part multiply(Part a, Part b) { return {_mm256_mul_pd(a.v, b.v)}; }
POLHODE_INLINE Part divide(Part a, Part b) { return {_mm256_div_pd(a.v, b.v)}; }
POLHODE_INLINE Part madd(Part a, Part b, Part c) { return {_mm256_fmadd_pd(a.v, b.v, c.v)}; }
POLHODE_INLINE Part take_part(const double* values, const std::int32_t* offset) {
  return {_mm256_setr_pd(values[offset[0]], values[offset[1]], values[offset[2]], values[offset[3]])};
}

#else

constexpr int octets_at_once = 1;
// Vectors of 128 bits, which every processor of today has. GCC splits longer ones badly.
struct Part {
  typedef double Vector __attribute__((vector_size(16)));
  Vector v;
};
typedef double Stored __attribute__((vector_size(16), may_alias));   // memory that is read as doubles too
POLHODE_INLINE Part load_part(const double* p) { return {*reinterpret_cast<const Stored*>(p)}; }
POLHODE_INLINE void store_part(double* p, Part a) { *reinterpret_cast<Stored*>(p) = a.v; }
POLHODE_INLINE Part all_part(double a) { return {Part::Vector{a, a}}; }
POLHODE_INLINE Part add(Part a, Part b) { return {a.v + b.v}; }
POLHODE_INLINE Part multiply(Part a, Part b) { return {a.v * b.v}; }
POLHODE_INLINE Part divide(Part a, Part b) { return {a.v / b.v}; }
POLHODE_INLINE Part madd(Part a, Part b, Part c) { return {a.v * b.v + c.v}; }
POLHODE_INLINE Part take_part(const double* values, const std::int32_t* offset) {
  return {Part::Vector{values[offset[0]], values[offset[1]]}};
}

#endif

// Members by name: GCC keeps arrays of registers in memory.
#if defined(__AVX2__)
struct Octet {
  Part a, b;
};
template <class Function>
POLHODE_INLINE Octet each(Function function) {
  return {function(&Octet::a, 0), function(&Octet::b, 4)};
}
#else
struct Octet {
  Part a, b, c, d;
};
template <class Function>
POLHODE_INLINE Octet each(Function function) {
  return {function(&Octet::a, 0), function(&Octet::b, 2), function(&Octet::c, 4), function(&Octet::d, 6)};
}
#endif
using Member = Part Octet::*;

POLHODE_INLINE Octet load(const double* p) {
  return each([&](Member, int at) POLHODE_LAMBDA { return load_part(p + at); });
}
POLHODE_INLINE void store(double* p, Octet x) {
  each([&](Member m, int at) POLHODE_LAMBDA {
    store_part(p + at, x.*m);
    return x.*m;
  });
}
POLHODE_INLINE Octet all(double value) {
  const Part part = all_part(value);
  return each([&](Member, int) POLHODE_LAMBDA { return part; });
}
POLHODE_INLINE Octet operator+(Octet x, Octet y) {
  return each([&](Member m, int) POLHODE_LAMBDA { return add(x.*m, y.*m); });
}
POLHODE_INLINE Octet operator*(Octet x, Octet y) {
  return each([&](Member m, int) POLHODE_LAMBDA { return multiply(x.*m, y.*m); });
}
POLHODE_INLINE Octet operator/(Octet x, Octet y) {
  return each([&](Member m, int) POLHODE_LAMBDA { return divide(x.*m, y.*m); });
}
POLHODE_INLINE Octet madd(Octet x, Octet y, Octet z) {
  return each([&](Member m, int) POLHODE_LAMBDA { return madd(x.*m, y.*m, z.*m); });
}
// Loads by offset: instructions that move numbers across halves of a register cost more.
POLHODE_INLINE Octet take(const double* values, const Pick& pick) {
  if (pick.move == Pick::Move::none) return load(values + pick.first);
  if (pick.move == Pick::Move::spread) return all(values[pick.offset[0]]);
  return each([&](Member, int at) POLHODE_LAMBDA { return take_part(values, pick.offset.data() + at); });
}
POLHODE_INLINE Octet gather(const double* values, const Pick* picks, Range range) {
  return take(values, picks[range.begin]);
}

#endif

}  // namespace polhode::formula::POLHODE_ISA
