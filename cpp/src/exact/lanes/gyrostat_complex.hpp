#pragma once

#include "math/lanes/scalar.hpp"
#include "polhode/math/detail/dd_functions.hpp"

// Complex numbers over double or double-double, for the set-up of the gyrostat.
namespace polhode::POLHODE_ISA::gyrostat {

using math::DD;

template <class N>
struct Complex {
  N re, im;
};
template <class N>
POLHODE_INLINE Complex<N> operator+(Complex<N> a, Complex<N> b) {
  return {a.re + b.re, a.im + b.im};
}
template <class N>
POLHODE_INLINE Complex<N> operator-(Complex<N> a, Complex<N> b) {
  return {a.re - b.re, a.im - b.im};
}
template <class N>
POLHODE_INLINE Complex<N> operator-(Complex<N> a) {
  return {-a.re, -a.im};
}
template <class N>
inline Complex<N> operator*(Complex<N> a, Complex<N> b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
template <class N>
POLHODE_INLINE Complex<N> operator*(N a, Complex<N> b) {
  return {a * b.re, a * b.im};
}
template <class N>
POLHODE_INLINE Complex<N> conj(Complex<N> a) {
  return {a.re, -a.im};
}
template <class N>
POLHODE_INLINE Complex<N> times_i(Complex<N> a) {
  return {-a.im, a.re};
}

inline DD squared(DD a) { return a * a; }
inline double squared(double a) { return a * a; }
template <class N>
inline N size2(Complex<N> a) {
  return squared(a.re) + squared(a.im);
}

/// The power of two by which a is divided, so that its larger part is near 1.
template <class N>
inline double unit_of(Complex<N> a) {
  return math::power_of_two_below(math::max(math::abs(math::rounded(a.re)), math::abs(math::rounded(a.im))));
}
inline double divided(double a, double unit) { return a / unit; }
inline DD divided(DD a, double unit) { return {a.hi / unit, a.lo / unit}; }
template <class N>
inline Complex<N> divided(Complex<N> a, double unit) {
  return {divided(a.re, unit), divided(a.im, unit)};
}

template <class N>
inline Complex<N> operator/(Complex<N> a, Complex<N> b) {
  const double unit = unit_of(b);
  const Complex<N> d = divided(b, unit), up = a * conj(d);
  const N scale = N(1.0) / size2(d);
  return divided(scale * up, unit);
}

inline double root_of(double a) { return a > 0.0 ? math::sqrt(a) : 0.0; }
inline DD root_of(DD a) { return a.hi > 0.0 ? math::sqrt(a) : DD(0.0); }

/// |a|.
template <class N>
inline N norm(Complex<N> a) {
  const double unit = unit_of(a);
  return unit * root_of(size2(divided(a, unit)));
}

/// The root with a real part >= 0.
template <class N>
inline Complex<N> square_root(Complex<N> a) {
  const N size = norm(a);
  if (math::rounded(size) == 0.0) return {N(0.0), N(0.0)};
  const bool right = math::rounded(a.re) >= 0.0;
  const N large = root_of(N(0.5) * (size + (right ? a.re : -a.re))), small = N(0.5) * a.im / large;
  if (right) return {large, small};
  return math::rounded(a.im) >= 0.0 ? Complex<N>{small, large} : Complex<N>{-small, -large};
}

inline Complex<double> rounded(Complex<DD> a) { return {a.re.hi, a.im.hi}; }
inline Complex<DD> widened(Complex<double> a) { return {DD(a.re), DD(a.im)}; }

// Transcendental functions on a number type of this instruction set, so that the linker shares no code between sets.
inline DD logarithm_of(DD x) {
  const auto y = math::log_dd(math::DoubleDouble<One>{One(x.hi), One(x.lo)});
  return {y.hi.v, y.lo.v};
}
inline DD angle_of(Complex<DD> a) {
  const auto y = math::atan2_dd(math::DoubleDouble<One>{One(a.im.hi), One(a.im.lo)},
                                math::DoubleDouble<One>{One(a.re.hi), One(a.re.lo)});
  return {y.hi.v, y.lo.v};
}

}  // namespace polhode::POLHODE_ISA::gyrostat
