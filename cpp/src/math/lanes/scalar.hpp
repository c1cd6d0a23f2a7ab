#pragma once

#include "polhode/math/detail/double_double.hpp"

// One lane, in a namespace of the file's own: a double by another name, so that nothing compiled here for a newer
// processor is ever an inline function of the whole program. POLHODE_ISA names that namespace.
namespace polhode::POLHODE_ISA {

struct One {
  static constexpr int width = 1;
  double v;
  POLHODE_INLINE One() = default;
  POLHODE_INLINE One(double a) : v(a) {}  // NOLINT(google-explicit-constructor)
  static POLHODE_INLINE One load(const double* p) { return *p; }
  POLHODE_INLINE void store(double* p) const { *p = v; }
};

POLHODE_INLINE One operator+(One a, One b) { return a.v + b.v; }
POLHODE_INLINE One operator-(One a, One b) { return a.v - b.v; }
POLHODE_INLINE One operator*(One a, One b) { return a.v * b.v; }
POLHODE_INLINE One operator/(One a, One b) { return a.v / b.v; }
POLHODE_INLINE One operator-(One a) { return -a.v; }
POLHODE_INLINE bool operator<(One a, One b) { return a.v < b.v; }
POLHODE_INLINE bool operator>(One a, One b) { return a.v > b.v; }
POLHODE_INLINE bool operator<=(One a, One b) { return a.v <= b.v; }
POLHODE_INLINE bool operator==(One a, One b) { return a.v == b.v; }
POLHODE_INLINE One select(bool mask, One a, One b) { return mask ? a : b; }
POLHODE_INLINE One rint(One a) { return math::rint(a.v); }
POLHODE_INLINE One sqrt(One a) { return __builtin_sqrt(a.v); }
POLHODE_INLINE One abs(One a) { return __builtin_fabs(a.v); }
POLHODE_INLINE One larger(One a, One b) { return a.v > b.v ? a : b; }
POLHODE_INLINE One copysign(One a, One b) { return __builtin_copysign(a.v, b.v); }
POLHODE_INLINE One power_of_two(One n) { return math::power_of_two(n.v); }
POLHODE_INLINE One power_of_two_below(One a) { return math::power_of_two_below(a.v); }
POLHODE_INLINE One exponent_of_power(One a) { return math::exponent_of_power(a.v); }
POLHODE_INLINE One guess_inverse_sqrt(One a) { return math::guess_inverse_sqrt(a.v); }
POLHODE_INLINE void add_quarters(One turns, One sin_r, One cos_r, One& sine, One& cosine) {
  math::add_quarters(turns.v, sin_r.v, cos_r.v, sine.v, cosine.v);
}
POLHODE_INLINE One madd(One a, One b, One c) { return math::madd(a.v, b.v, c.v); }
#ifdef __FMA__
POLHODE_INLINE One fma(One a, One b, One c) { return __builtin_fma(a.v, b.v, c.v); }
#else
POLHODE_INLINE math::DoubleDouble<One> two_prod(One a, One b) {
  const math::DD p = math::two_prod(a.v, b.v);
  return {One(p.hi), One(p.lo)};
}
#endif

POLHODE_INLINE void load3(const double* p, One& a, One& b, One& c) { a = p[0], b = p[1], c = p[2]; }
POLHODE_INLINE void load4(const double* p, One& a, One& b, One& c, One& d) { a = p[0], b = p[1], c = p[2], d = p[3]; }
POLHODE_INLINE void store3(double* p, One a, One b, One c) { p[0] = a.v, p[1] = b.v, p[2] = c.v; }
POLHODE_INLINE void store4(double* p, One a, One b, One c, One d) { p[0] = a.v, p[1] = b.v, p[2] = c.v, p[3] = d.v; }

}  // namespace polhode::POLHODE_ISA
