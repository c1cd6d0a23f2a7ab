#pragma once

#include <cmath>
#include <limits>

#include "polhode/math/detail/double_double.hpp"

namespace polhode::math {

/// A set of real numbers: all within `radius` of `middle`. Each operation returns a set that holds every exact result.
///
/// The rounding mode is never changed: the middle is a double-double, and the radius grows by a bound on its rounding.
/// That bound is 2^-101 relative (Joldes, Muller, Popescu 2017, ACM TOMS 44(2), 15: at most 7 * 2^-106) and 2^-1000
/// absolute, for products whose low half underflows. A result without a finite bound is the whole line.
///
/// Midpoint and radius, as in Johansson 2017, IEEE Trans. Comput. 66, 1281: sums of many terms cost little more than
/// the sums of their middles.
struct Interval {
  static constexpr double relative = 0x1p-101, absolute = 0x1p-1000;
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  DD middle = {};
  double radius = 0.0;

  Interval() = default;
  Interval(double value) : Interval(DD(value), 0.0) {}  // NOLINT(google-explicit-constructor)
  Interval(DD m, double r) : middle(m), radius(r) {
    if (!(std::abs(m.hi) + r < infinity)) middle = {}, radius = infinity;   // NaN, too
  }

  static Interval all() { return {DD(0.0), infinity}; }

  bool is_zero() const { return middle.hi == 0.0 && radius == 0.0; }
  bool is_bounded() const { return radius < infinity; }

  double lower() const { return -Interval(-middle, radius).upper(); }
  double upper() const {
    // The sum is rounded to nearest: one number further is above the exact one.
    if (!is_bounded()) return infinity;
    const DD s = two_sum(middle.hi, radius);
    const double rest = middle.lo + s.lo;
    const double sum = s.hi + rest;
    return radius == 0.0 && middle.lo == 0.0 ? middle.hi : std::nextafter(sum, infinity);
  }
  /// At least |x| for every x of the set.
  double magnitude() const { return raise(std::abs(middle.hi) + std::abs(middle.lo) + radius); }
  /// At most |x| for every x of the set; 0 where it holds 0.
  double mignitude() const {
    const double least = (std::abs(middle.hi) - radius) * (1.0 - 0x1p-48) - 2 * std::abs(middle.lo);
    return least > 0.0 ? least : 0.0;
  }
  bool contains(double x) const { return lower() <= x && x <= upper(); }

  /// At least the exact value of a sum of a few products of numbers that are not negative, computed to nearest.
  static double raise(double x) { return x == 0.0 ? 0.0 : x * (1.0 + 0x1p-48) + 0x1p-1070; }

  friend Interval operator-(const Interval& a) { return {-a.middle, a.radius}; }
  friend Interval operator+(const Interval& a, const Interval& b) {
    const DD sum = a.middle + b.middle;
    return {sum, raise(a.radius + b.radius + relative * std::abs(sum.hi))};
  }
  friend Interval operator-(const Interval& a, const Interval& b) { return a + (-b); }
  friend Interval operator*(const Interval& a, const Interval& b) {
    if (a.is_zero() || b.is_zero()) return a.is_bounded() && b.is_bounded() ? Interval() : all();
    const DD product = a.middle * b.middle;
    const double A = std::abs(a.middle.hi), B = std::abs(b.middle.hi);
    return {product, raise(a.radius * (B * (1.0 + 0x1p-50) + b.radius) + A * (1.0 + 0x1p-50) * b.radius +
                           relative * std::abs(product.hi)) + absolute};
  }
  friend Interval operator/(const Interval& a, const Interval& b) {
    const double least = b.mignitude();
    if (!(least > 0.0) || !a.is_bounded() || !b.is_bounded()) return all();
    if (a.is_zero()) return {};
    const DD quotient = a.middle / b.middle;
    // a / b - q = (a - q b) / b, for any rounding of q.
    return {quotient, raise((a - Interval(quotient, 0.0) * b).magnitude() / least) + absolute};
  }
};

/// The exact square, which is never negative.
inline Interval sqr(const Interval& a) {
  const Interval square = a * a;
  if (square.mignitude() > 0.0 || !square.is_bounded() || a.is_zero()) return square;
  const double most = a.magnitude();
  return {DD(0.5 * most * most), Interval::raise(0.5 * most * most) + Interval::absolute};
}

/// Of what is not negative in the set.
inline Interval sqrt(const Interval& a) {
  if (!a.is_bounded()) return a;
  if (a.is_zero()) return {};
  const double least = a.mignitude();
  if (!(least > 0.0) || a.middle.hi < 0.0) {
    const double most = Interval::raise(std::sqrt(a.magnitude()));   // the radius: 0 is the least
    return {DD(0.5 * most), Interval::raise(0.5 * most)};
  }
  const DD root = sqrt(a.middle);
  // sqrt(x) - s = (x - s^2) / (sqrt(x) + s)
  const Interval s(root, 0.0);
  return {root, Interval::raise((a - s * s).magnitude() / (std::sqrt(least) * (1.0 - 0x1p-50))) + Interval::absolute};
}

struct IntervalSinCos {
  Interval sin, cos;
};

/// Sine and cosine. The radius grows as 1e-32 |angle|.
inline IntervalSinCos sincos(const Interval& angle) {
  // pi / 2 lies within 2^-109 of this double-double.
  static const Interval quarter(DD(1.5707963267948966, 6.123233995736766e-17), 0x1p-108);
  const Interval unit(DD(0.0), 1.0);
  const double turns = std::nearbyint(angle.middle.hi / quarter.middle.hi);
  const Interval x = angle - quarter * Interval(turns);
  if (!(x.magnitude() < 1.0) || std::abs(turns) > 0x1p50) return {unit, unit};
  const Interval square = -sqr(x);
  Interval sine(1.0), cosine(1.0), term_s(1.0), term_c(1.0);
  constexpr int terms = 15;
  for (int k = 1; k <= terms; ++k) {
    term_c = term_c * square / Interval((2.0 * k - 1.0) * (2.0 * k));
    term_s = term_s * square / Interval(2.0 * k * (2.0 * k + 1.0));
    cosine = cosine + term_c, sine = sine + term_s;
  }
  // An alternating series of falling terms: what is left out is smaller than the last term that is kept.
  cosine.radius = Interval::raise(cosine.radius + term_c.magnitude());
  sine.radius = Interval::raise(sine.radius + term_s.magnitude());
  sine = sine * x;
  switch (static_cast<int>(turns - 4.0 * std::floor(turns / 4.0))) {
    case 0: return {sine, cosine};
    case 1: return {cosine, -sine};
    case 2: return {-sine, -cosine};
    default: return {-cosine, sine};
  }
}

}  // namespace polhode::math
