#pragma once

#include <algorithm>
#include <cmath>

#include "polhode/math/detail/interval.hpp"

// Functions of intervals. A residual that is enclosed corrects an approximate value, so that nothing rests on it.
namespace polhode::math {

namespace detail {

/// e^x of one number, |x| <= 600.
inline Interval exp_point(const DD& x) {
  // log 2 lies within 2^-109 of this double-double.
  static const Interval log_two(DD(0.6931471805599453, 2.3190468138462996e-17), 0x1p-108);
  const double turns = std::nearbyint(x.hi / log_two.middle.hi);
  const Interval part = (Interval(x, 0.0) - log_two * Interval(turns)) * Interval(0x1p-4);
  Interval sum(1.0), term(1.0);
  for (int k = 1; k <= 18; ++k) {
    term = term * part / Interval(static_cast<double>(k));
    sum = sum + term;
  }
  // |part| < 1/32: each further term is less than half the last.
  sum.radius = Interval::raise(sum.radius + term.magnitude());
  for (int k = 0; k < 4; ++k) sum = sqr(sum);
  return sum * Interval(std::ldexp(1.0, static_cast<int>(turns)));
}

}  // namespace detail

/// e^a; the whole line for a radius above 1, or beyond e^600.
inline Interval exp(const Interval& a) {
  if (!(a.radius <= 1.0) || !(a.middle.hi <= 600.0)) return Interval::all();
  if (!(a.middle.hi >= -600.0)) return {DD(0.0), 0x1p-800};   // e^-599
  const Interval middle = detail::exp_point(a.middle);
  // e^r - 1 <= r + r^2 for 0 <= r <= 1
  const double wider = middle.magnitude() * (a.radius + a.radius * a.radius);
  return {middle.middle, Interval::raise(middle.radius + Interval::raise(wider))};
}

/// log a; the whole line where it holds 0, or a number below.
inline Interval log(const Interval& a) {
  if (!(a.mignitude() > 0.0) || !(a.middle.hi > 0.0)) return Interval::all();
  const DD y = log(a.middle);
  if (!(std::abs(y.hi) < 600.0)) return Interval::all();
  const Interval off = a * detail::exp_point(-y) - Interval(1.0);
  const double size = off.magnitude();
  if (!(size < 1.0)) return Interval::all();
  // |log(1 + x)| <= |x| / (1 - |x|), and |log(1 + x) - x| <= x^2 for |x| <= 1/4
  if (size > 0.25) return {y, Interval::raise(size / (1.0 - size)) * (1.0 + 0x1p-40)};
  return Interval(y, 0.0) + off + Interval(DD(0.0), Interval::raise(size * size));
}

inline Interval tanh(const Interval& a) {
  if (!a.is_bounded()) return {DD(0.0), 1.0};
  const double sign = a.middle.hi < 0.0 ? -1.0 : 1.0, size = std::abs(a.middle.hi);
  const Interval power = size > 300.0 ? Interval(DD(0.0), 0x1p-800)
                                      : detail::exp_point(DD(-2.0 * sign * a.middle.hi, -2.0 * sign * a.middle.lo));
  Interval value = Interval(sign) * ((Interval(1.0) - power) / (Interval(1.0) + power));
  value.radius = Interval::raise(value.radius + a.radius);   // |tanh'| <= 1
  return value;
}

/// The angle of a point from the x axis, near that of the middles: it runs on across the cut. The whole line where the
/// set has points too far apart.
inline Interval atan2(const Interval& y, const Interval& x) {
  if (!y.is_bounded() || !x.is_bounded() || (y.middle.hi == 0.0 && x.middle.hi == 0.0)) return Interval::all();
  const DD angle = atan2(y.middle, x.middle);
  const IntervalSinCos direction = sincos(Interval(angle, 0.0));
  const Interval across = y * direction.cos - x * direction.sin, along = x * direction.cos + y * direction.sin;
  if (!(along.mignitude() > 0.0) || !(along.middle.hi > 0.0)) return Interval::all();
  const Interval tangent = across / along;
  const double size = tangent.magnitude();
  if (!(size <= 0.5)) return Interval::all();
  // |atan x - x| <= |x|^3
  return Interval(angle, 0.0) + tangent + Interval(DD(0.0), Interval::raise(Interval::raise(size * size) * size));
}

}  // namespace polhode::math
