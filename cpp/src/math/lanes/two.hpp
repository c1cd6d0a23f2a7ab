#pragma once

#include <cstddef>

#include "polhode/math/detail/double_double.hpp"

// Included after the file that defines `Wide` for the instruction set.
namespace polhode::POLHODE_ISA {

/// Two registers side by side: the processor computes in one while the other waits for a division or a sum. It pays
/// where a formula is one long chain, as the set-up of a body is.
struct Two {
  static constexpr int width = 2 * Wide::width;
  Wide first, second;
  POLHODE_INLINE Two() = default;
  POLHODE_INLINE Two(Wide a, Wide b) : first(a), second(b) {}
  POLHODE_INLINE Two(double a) : first(a), second(a) {}  // NOLINT(google-explicit-constructor)
  static POLHODE_INLINE Two load(const double* p) { return {Wide::load(p), Wide::load(p + Wide::width)}; }
  POLHODE_INLINE void store(double* p) const { first.store(p), second.store(p + Wide::width); }
};

struct TwoMask {
  math::Mask<Wide> first, second;
};

// clang-format off
#define POLHODE_OPERATOR(result, op) \
  POLHODE_INLINE result operator op(Two a, Two b) { return {a.first op b.first, a.second op b.second}; }
POLHODE_OPERATOR(Two, +) POLHODE_OPERATOR(Two, -) POLHODE_OPERATOR(Two, *) POLHODE_OPERATOR(Two, /)
POLHODE_OPERATOR(TwoMask, <) POLHODE_OPERATOR(TwoMask, >) POLHODE_OPERATOR(TwoMask, <=) POLHODE_OPERATOR(TwoMask, ==)
#undef POLHODE_OPERATOR
#define POLHODE_FUNCTION(f) POLHODE_INLINE Two f(Two a) { return {f(a.first), f(a.second)}; }
POLHODE_FUNCTION(rint) POLHODE_FUNCTION(sqrt) POLHODE_FUNCTION(abs) POLHODE_FUNCTION(power_of_two)
POLHODE_FUNCTION(power_of_two_below) POLHODE_FUNCTION(exponent_of_power) POLHODE_FUNCTION(guess_inverse_sqrt)
#undef POLHODE_FUNCTION
// clang-format on

POLHODE_INLINE Two operator-(Two a) { return {-a.first, -a.second}; }
POLHODE_INLINE TwoMask operator&(TwoMask a, TwoMask b) {
  return {math::Mask<Wide>(a.first & b.first), math::Mask<Wide>(a.second & b.second)};
}
POLHODE_INLINE TwoMask operator|(TwoMask a, TwoMask b) {
  return {math::Mask<Wide>(a.first | b.first), math::Mask<Wide>(a.second | b.second)};
}
POLHODE_INLINE Two select(TwoMask mask, Two a, Two b) {
  return {select(mask.first, a.first, b.first), select(mask.second, a.second, b.second)};
}
POLHODE_INLINE Two madd(Two a, Two b, Two c) {
  return {madd(a.first, b.first, c.first), madd(a.second, b.second, c.second)};
}
#ifdef __FMA__
POLHODE_INLINE Two fma(Two a, Two b, Two c) {
  return {fma(a.first, b.first, c.first), fma(a.second, b.second, c.second)};
}
#else
POLHODE_INLINE math::DoubleDouble<Two> two_prod(Two a, Two b) {
  const math::DoubleDouble<Wide> first = two_prod(a.first, b.first), second = two_prod(a.second, b.second);
  return {{first.hi, second.hi}, {first.lo, second.lo}};
}
#endif
POLHODE_INLINE Two copysign(Two a, Two b) { return {copysign(a.first, b.first), copysign(a.second, b.second)}; }
POLHODE_INLINE void add_quarters(Two turns, Two sin_r, Two cos_r, Two& sine, Two& cosine) {
  add_quarters(turns.first, sin_r.first, cos_r.first, sine.first, cosine.first);
  add_quarters(turns.second, sin_r.second, cos_r.second, sine.second, cosine.second);
}
POLHODE_INLINE void store3(double* p, Two x, Two y, Two z) {
  store3(p, x.first, y.first, z.first);
  store3(p + 3 * Wide::width, x.second, y.second, z.second);
}
POLHODE_INLINE void store4(double* p, Two x, Two y, Two z, Two w) {
  store4(p, x.first, y.first, z.first, w.first);
  store4(p + 4 * Wide::width, x.second, y.second, z.second, w.second);
}

POLHODE_INLINE void load3(const double* p, Two& x, Two& y, Two& z) {
  load3(p, x.first, y.first, z.first);
  load3(p + 3 * Wide::width, x.second, y.second, z.second);
}
POLHODE_INLINE void load4(const double* p, Two& x, Two& y, Two& z, Two& w) {
  load4(p, x.first, y.first, z.first, w.first);
  load4(p + 4 * Wide::width, x.second, y.second, z.second, w.second);
}


/// Calls work<T>(k) for as many of n numbers as fill lanes, T::width at k: two registers at a time, then one. Returns
/// how many are done.
template <class Work>
POLHODE_INLINE std::size_t in_twos(std::size_t n, const Work& work) {
  std::size_t k = 0;
  for (; k + Two::width <= n; k += Two::width) work.template operator()<Two>(k);
  for (; k + Wide::width <= n; k += Wide::width) work.template operator()<Wide>(k);
  return k;
}

}  // namespace polhode::POLHODE_ISA
