#pragma once

#include "math/lanes/scalar.hpp"
#include "polhode/exact/detail/heavy_top_kernel.hpp"
#include "polhode/math/detail/dd_functions.hpp"

// Complex numbers in double-double, for the set-up of the top.
namespace polhode::POLHODE_ISA {

using exact::Cycles;
using math::DD, math::abs, math::sqrt;

// Transcendental functions on a number type of this instruction set, so that the linker shares no code between sets.
inline DD narrow(math::DoubleDouble<One> a) { return {a.hi.v, a.lo.v}; }
inline math::DoubleDouble<One> widen(DD a) { return {One(a.hi), One(a.lo)}; }
inline DD angle_of(DD y, DD x) { return narrow(math::atan2_dd(widen(y), widen(x))); }
/// The logarithm of any x > 0.
inline DD logarithm(DD x) {
  const DD ln2{0.6931471805599453, 2.3190468138462996e-17};
  const double power = x.hi < 0x1p-800 ? -512.0 : x.hi > 0x1p800 ? 512.0 : 0.0;
  return narrow(math::log_dd(widen(math::scaled(x, math::power_of_two(-power))))) + ln2 * DD(power);
}

inline DD squared(DD a) { return a * a; }

struct Complex {
  DD re, im;
};
inline Complex operator*(Complex a, Complex b) { return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }
inline Complex operator*(DD a, Complex b) { return {a * b.re, a * b.im}; }
inline Complex operator+(Complex a, Complex b) { return {a.re + b.re, a.im + b.im}; }
inline Complex operator-(Complex a, Complex b) { return {a.re - b.re, a.im - b.im}; }
inline Complex conj(Complex a) { return {a.re, -a.im}; }
inline Complex times_i(Complex a) { return {-a.im, a.re}; }

/// a times a power of two, so that its larger part is near 1; 0 stays 0.
inline Complex balanced(Complex a) {
  const double scale = 1.0 / math::power_of_two_below(math::max(abs(a.re.hi), abs(a.im.hi)));
  return {math::scaled(a.re, scale), math::scaled(a.im, scale)};
}

/// a / |a|, and 1 for 0.
inline Complex unit(Complex a) {
  a = balanced(a);
  const DD n = squared(a.re) + squared(a.im);
  if (n.hi == 0.0) return {DD(1.0), DD(0.0)};
  const DD inverse = DD(1.0) / math::sqrt(n);
  return {a.re * inverse, a.im * inverse};
}

inline double size2(Complex a) { return a.re.hi * a.re.hi + a.im.hi * a.im.hi; }
inline DD norm(Complex a) { return math::sqrt(squared(a.re) + squared(a.im)); }

inline Cycles in_cycles(DD angle) {
  const DD cycles = angle / (math::pi<DD>() + math::pi<DD>());
  return {cycles.hi, cycles.lo};
}

}  // namespace polhode::POLHODE_ISA
