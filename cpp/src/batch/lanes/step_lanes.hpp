#pragma once

#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>
#if defined(__FMA__)
#include <immintrin.h>
#endif

#include "polhode/math/detail/number.hpp"
#include "polhode/step.hpp"

// Bodies side by side in registers, for polhode/step.hpp. Each file that is built for one instruction set includes this
// header once, and POLHODE_ISA names its namespace.
namespace polhode::POLHODE_ISA {

/// Two registers of numbers: two independent chains of operations hide the latency of each.
template <class S>
struct Lanes {
#if defined(__AVX512F__)
  static constexpr int bytes = 64;
#elif defined(__AVX2__)
  static constexpr int bytes = 32;
#else
  static constexpr int bytes = 4 * sizeof(S);
#endif
  static constexpr int width = bytes / static_cast<int>(sizeof(S));   ///< of one register
  using Bit = std::conditional_t<sizeof(S) == 4, std::uint32_t, std::uint64_t>;
  typedef S V __attribute__((vector_size(bytes)));
  typedef Bit Bits __attribute__((vector_size(bytes)));

  V a, b;
};

POLHODE_INLINE auto fused(Lanes<float>::V a, Lanes<float>::V b, Lanes<float>::V c) {
#if defined(__AVX512F__)
  return static_cast<Lanes<float>::V>(_mm512_fmadd_ps(a, b, c));
#elif defined(__FMA__)
  return static_cast<Lanes<float>::V>(_mm256_fmadd_ps(a, b, c));
#else
  return a * b + c;
#endif
}
POLHODE_INLINE auto fused(Lanes<double>::V a, Lanes<double>::V b, Lanes<double>::V c) {
#if defined(__AVX512F__)
  return static_cast<Lanes<double>::V>(_mm512_fmadd_pd(a, b, c));
#elif defined(__FMA__)
  return static_cast<Lanes<double>::V>(_mm256_fmadd_pd(a, b, c));
#else
  return a * b + c;
#endif
}

template <class S>
POLHODE_INLINE Lanes<S> operator+(Lanes<S> x, Lanes<S> y) { return {x.a + y.a, x.b + y.b}; }
template <class S>
POLHODE_INLINE Lanes<S> operator-(Lanes<S> x, Lanes<S> y) { return {x.a - y.a, x.b - y.b}; }
template <class S>
POLHODE_INLINE Lanes<S> operator*(Lanes<S> x, Lanes<S> y) { return {x.a * y.a, x.b * y.b}; }
template <class S>
POLHODE_INLINE Lanes<S> operator/(Lanes<S> x, Lanes<S> y) { return {x.a / y.a, x.b / y.b}; }
template <class S>
POLHODE_INLINE Lanes<S> operator-(Lanes<S> x) { return {-x.a, -x.b}; }

}  // namespace polhode::POLHODE_ISA

/// The operations of step.hpp. Each is one that IEEE 754 fixes: AVX2 and AVX-512 give the same bits.
template <class S>
struct polhode::step::Ops<polhode::POLHODE_ISA::Lanes<S>> {
  using T = POLHODE_ISA::Lanes<S>;
  using V = typename T::V;
  using Bits = typename T::Bits;
  static constexpr bool scalar = false, single = sizeof(S) == 4;

  static POLHODE_INLINE T set(double x) { return {V{} + static_cast<S>(x), V{} + static_cast<S>(x)}; }
  static POLHODE_INLINE T madd(T a, T b, T c) {
    return {POLHODE_ISA::fused(a.a, b.a, c.a), POLHODE_ISA::fused(a.b, b.b, c.b)};
  }
  static POLHODE_INLINE T pick(T a, T b, T x, T y) { return {a.a < b.a ? x.a : y.a, a.b < b.b ? x.b : y.b}; }
  static POLHODE_INLINE T nearest(T x) {
    const T big = set(single ? 0x1.8p23 : 0x1.8p52);
    return (x + big) - big;
  }
  static POLHODE_INLINE T root(T x) { return x * inverse_root(x); }

  /// A guess from the bits (error 3.4 %), Halley's steps to 1e-4 and 3e-12, and Newton's to rounding. Faster than a
  /// division and a root, and with the same bits everywhere.
  static POLHODE_INLINE T inverse_root(T x) {
    T y{guess(x.a), guess(x.b)};
    for (int i = single ? 1 : 0; i < 2; ++i) {
      const T e = madd(-x * y, y, set(1));
      y = madd(y * e, madd(e, set(0.375), set(0.5)), y);
    }
    return madd(set(0.5) * y, madd(-x * y, y, set(1)), y);
  }

 private:
  static POLHODE_INLINE V guess(V x) {
    constexpr auto magic = static_cast<typename T::Bit>(single ? 0x5f3759df : 0x5fe6eb50c7b537a9);
    return reinterpret_cast<V>(magic - (reinterpret_cast<Bits>(x) >> 1));
  }
};
