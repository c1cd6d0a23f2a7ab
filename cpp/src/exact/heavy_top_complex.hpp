#pragma once

#include <algorithm>
#include <cmath>

#include "polhode/exact/heavy_top_kernel.hpp"
#include "polhode/math/double_double.hpp"

// Complex numbers in double-double, as far as the set-up of the top needs them.
namespace polhode::exact {

using math::DD;

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


/// a / |a|, and 1 for 0; also where the squares would under- or overflow.
inline Complex unit(Complex a) {
  const double size = std::max(std::abs(a.re.hi), std::abs(a.im.hi));
  if (size == 0.0) return {DD(1.0), DD(0.0)};
  const double scale = std::ldexp(1.0, -std::ilogb(size));
  a = {math::scaled(a.re, scale), math::scaled(a.im, scale)};
  const DD n = math::sqrt(squared(a.re) + squared(a.im));
  return {a.re / n, a.im / n};
}

inline DD norm(Complex a) { return math::sqrt(squared(a.re) + squared(a.im)); }

inline Cycles in_cycles(DD angle) {
  const DD cycles = angle / (math::pi<DD>() + math::pi<DD>());
  return {cycles.hi, cycles.lo};
}

}  // namespace polhode::exact
