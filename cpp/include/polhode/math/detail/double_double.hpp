#pragma once

#include "polhode/math/detail/number.hpp"

namespace polhode::math {

/// An unevaluated sum hi + lo with |lo| <= ulp(hi)/2: 106 bits, the range of the base type.
/// Products below 1e-290 lose their low half: scale by powers of two first.
/// Dekker 1971, Numer. Math. 18, 224; error bounds: Joldes, Muller, Popescu 2017, ACM TOMS 44(2), 15.
template <class T>
struct DoubleDouble {
  T hi = T(0.0);
  T lo = T(0.0);

  POLHODE_INLINE DoubleDouble() = default;
  POLHODE_INLINE DoubleDouble(T value) : hi(value) {}  // NOLINT(google-explicit-constructor)
  POLHODE_INLINE DoubleDouble(T h, T l) : hi(h), lo(l) {}
};

using DD = DoubleDouble<double>;

/// a + b exactly (Knuth).
template <class T>
POLHODE_INLINE DoubleDouble<T> two_sum(T a, T b) {
  const T s = a + b, bb = s - a;
  return {s, (a - (s - bb)) + (b - bb)};
}

/// a + b exactly when |a| >= |b| or a = 0 (Dekker).
template <class T>
POLHODE_INLINE DoubleDouble<T> fast_two_sum(T a, T b) {
  const T s = a + b;
  return {s, b - (s - a)};
}

/// a b exactly.
template <class T>
POLHODE_INLINE DoubleDouble<T> two_prod(T a, T b) {
  const T p = a * b;
  return {p, fma(a, b, -p)};
}

#ifndef __FMA__
/// a b exactly by Veltkamp's splitting, where a fused multiply-add would be a call; |a|, |b| < 1e290.
template <>
POLHODE_INLINE DD two_prod<double>(double a, double b) {
  constexpr double split = 134217729.0;  // 2^27 + 1
  const double p = a * b;
  const double ta = split * a, ah = ta - (ta - a), al = a - ah;
  const double tb = split * b, bh = tb - (tb - b), bl = b - bh;
  return {p, ((ah * bh - p) + ah * bl + al * bh) + al * bl};
}
#endif

template <class T>
POLHODE_INLINE DoubleDouble<T> operator-(DoubleDouble<T> a) {
  return {-a.hi, -a.lo};
}

template <class T>
POLHODE_INLINE DoubleDouble<T> operator+(DoubleDouble<T> a, DoubleDouble<T> b) {
  const auto s = two_sum(a.hi, b.hi), t = two_sum(a.lo, b.lo);
  const auto v = fast_two_sum(s.hi, s.lo + t.hi);
  return fast_two_sum(v.hi, v.lo + t.lo);
}

/// a + b at half the cost, for terms of one sign: between opposite signs it cancels as plain numbers do.
template <class T>
POLHODE_INLINE DoubleDouble<T> plus(DoubleDouble<T> a, DoubleDouble<T> b) {
  const auto s = two_sum(a.hi, b.hi);
  return fast_two_sum(s.hi, s.lo + (a.lo + b.lo));
}
template <class T>
POLHODE_INLINE T plus(T a, T b) {
  return a + b;
}

/// 1 + a for 0 <= a <= 1.
template <class T>
POLHODE_INLINE DoubleDouble<T> one_plus(DoubleDouble<T> a) {
  const auto s = fast_two_sum(T(1.0), a.hi);
  return fast_two_sum(s.hi, s.lo + a.lo);
}
template <class T>
POLHODE_INLINE T one_plus(T a) {
  return T(1.0) + a;
}

/// 2 a, exactly.
template <class T>
POLHODE_INLINE DoubleDouble<T> twice(DoubleDouble<T> a) {
  return {a.hi + a.hi, a.lo + a.lo};
}
template <class T>
POLHODE_INLINE T twice(T a) {
  return a + a;
}

template <class T>
POLHODE_INLINE DoubleDouble<T> operator-(DoubleDouble<T> a, DoubleDouble<T> b) {
  return a + (-b);
}

template <class T>
POLHODE_INLINE DoubleDouble<T> operator*(DoubleDouble<T> a, DoubleDouble<T> b) {
  const auto p = two_prod(a.hi, b.hi);
  return fast_two_sum(p.hi, p.lo + madd(a.hi, b.lo, a.lo * b.hi));
}

template <class T>
POLHODE_INLINE DoubleDouble<T> operator/(DoubleDouble<T> a, DoubleDouble<T> b) {
  const T inverse = T(1.0) / b.hi, q = a.hi * inverse;
  const auto p = two_prod(q, b.hi);
  const T remainder = ((a.hi - p.hi) - p.lo) + (a.lo - q * b.lo);
  return fast_two_sum(q, remainder * inverse);
}

template <class T>
POLHODE_INLINE DoubleDouble<T> sqrt(DoubleDouble<T> a) {
  const T s = sqrt(a.hi);
  const auto p = two_prod(s, s);
  const T remainder = ((a.hi - p.hi) - p.lo) + a.lo;
  return fast_two_sum(s, select(s > T(0.0), remainder / (s + s), T(0.0)));
}

// clang-format off
#define POLHODE_MIXED(op)                                                                                             \
  template <class T> POLHODE_INLINE DoubleDouble<T> operator op(DoubleDouble<T> a, T b) { return a op DoubleDouble<T>(b); } \
  template <class T> POLHODE_INLINE DoubleDouble<T> operator op(T a, DoubleDouble<T> b) { return DoubleDouble<T>(a) op b; }
POLHODE_MIXED(+) POLHODE_MIXED(-) POLHODE_MIXED(*) POLHODE_MIXED(/)
#undef POLHODE_MIXED

template <class T> POLHODE_INLINE Mask<T> operator<(DoubleDouble<T> a, DoubleDouble<T> b) { return Mask<T>((a.hi < b.hi) | ((a.hi == b.hi) & (a.lo < b.lo))); }
template <class T> POLHODE_INLINE Mask<T> operator>(DoubleDouble<T> a, DoubleDouble<T> b) { return b < a; }
template <class T> POLHODE_INLINE Mask<T> operator==(DoubleDouble<T> a, DoubleDouble<T> b) { return Mask<T>((a.hi == b.hi) & (a.lo == b.lo)); }
template <class T> POLHODE_INLINE Mask<T> operator<=(DoubleDouble<T> a, DoubleDouble<T> b) { return Mask<T>((a.hi < b.hi) | ((a.hi == b.hi) & (a.lo <= b.lo))); }
template <class T> POLHODE_INLINE Mask<T> operator>=(DoubleDouble<T> a, DoubleDouble<T> b) { return b <= a; }
// clang-format on

template <class T, class M>
POLHODE_INLINE DoubleDouble<T> select(M mask, DoubleDouble<T> a, DoubleDouble<T> b) {
  return {select(mask, a.hi, b.hi), select(mask, a.lo, b.lo)};
}

template <class T>
POLHODE_INLINE DoubleDouble<T> madd(DoubleDouble<T> a, DoubleDouble<T> b, DoubleDouble<T> c) {
  return a * b + c;
}

template <class T>
POLHODE_INLINE DoubleDouble<T> abs(DoubleDouble<T> a) {
  return select(a.hi < T(0.0), -a, a);
}

/// a 2^k for the factor 2^k given as a number: exact unless it underflows.
template <class T>
POLHODE_INLINE DoubleDouble<T> scaled(DoubleDouble<T> a, T power_of_two) {
  return {a.hi * power_of_two, a.lo * power_of_two};
}

/// a - b exactly.
template <class T>
POLHODE_INLINE DoubleDouble<T> two_diff(T a, T b) {
  return two_sum(a, -b);
}

/// The nearest number of the base type, from a plain number or a double-double alike.
POLHODE_INLINE double rounded(double a) { return a; }
template <class T>
POLHODE_INLINE T rounded(DoubleDouble<T> a) {
  return a.hi;
}

/// A constant known to 106 bits as a number of type N: the template parameter decides what is kept.
template <class N>
struct Constant {
  static POLHODE_INLINE N of(double hi, double) { return N(hi); }
};
template <class T>
struct Constant<DoubleDouble<T>> {
  static POLHODE_INLINE DoubleDouble<T> of(double hi, double lo) { return {T(hi), T(lo)}; }
};

template <class N>
POLHODE_INLINE N pi() {
  return Constant<N>::of(3.141592653589793, 1.2246467991473532e-16);
}

// ---- Transcendental functions, for set-ups (one number at a time, relative error about 1e-31) ----

struct SinCos {
  DD sin, cos;
};

SinCos sincos(DD angle);    ///< |angle| up to 1e15; its absolute error grows as 1e-33 |angle|
DD exp(DD x);               ///< 0 below about -745; inf above 709
DD log(DD x);               ///< x > 0
DD atan2(DD y, DD x);       ///< in (-pi, pi]; not both 0

}  // namespace polhode::math
