#include "orbit/kepler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "polhode/math/detail/functions.hpp"

namespace polhode::kepler {
namespace {

using math::DD;

constexpr double series_below = 2.0;      // of |psi|: sin and sinh would cancel in c3
constexpr int double_terms = 14, dd_terms = 24;   // 2^14 / 31! < 1e-29, 2^24 / 51! < 1e-58

/// c2 and c3 by their series, nested: the k-th is 1/k! (1 - psi/((k+1)(k+2)) (1 - ...)).
template <class T>
T sum_stumpff(T psi, int k, int terms) {
  T sum(1.0);
  for (int j = terms; j-- > 0;) {
    const double next = static_cast<double>((2 * j + k + 1) * (2 * j + k + 2));
    sum = T(1.0) - psi * sum / T(next);
  }
  return sum / T(k == 2 ? 2.0 : 6.0);
}

template <class T>
Anomaly<T> sum_series(T alpha, T chi, int terms) {
  const T square = chi * chi, psi = alpha * square;
  const T c2 = sum_stumpff(psi, 2, terms), c3 = sum_stumpff(psi, 3, terms);
  return {T(1.0) - psi * c2, chi * (T(1.0) - psi * c3), square * c2, square * chi * c3};
}

DD asinh(DD x) {
  if (math::abs(x).hi < 1e-8) return x - x * x * x / DD(6.0);
  const DD positive = math::abs(x);
  const DD value = math::log(positive + math::sqrt(DD(1.0) + x * x));
  return x.hi < 0 ? -value : value;
}

}  // namespace

Anomaly<double> compute_anomaly(double alpha, double chi) {
  const double psi = alpha * chi * chi;
  if (std::abs(psi) < series_below) return sum_series(alpha, chi, double_terms);
  const double root = std::sqrt(std::abs(alpha)), angle = root * chi;
  if (alpha > 0.0) {
    const math::SinCosPair whole = math::sincos(angle);
    const double half = math::sin(0.5 * angle);
    return {whole.cos, whole.sin / root, 2 * half * half / alpha, (angle - whole.sin) / (alpha * root)};
  }
  const double grow = math::exp(angle), sinh = 0.5 * (grow - 1 / grow), cosh = 0.5 * (grow + 1 / grow);
  return {cosh, sinh / root, (1 - cosh) / alpha, (angle - sinh) / (alpha * root)};
}

Anomaly<DD> compute_anomaly(DD alpha, DD chi) {
  const DD psi = alpha * chi * chi;
  if (std::abs(psi.hi) < series_below) return sum_series(alpha, chi, dd_terms);
  const DD root = math::sqrt(math::abs(alpha)), angle = root * chi;
  if (alpha.hi > 0.0) {
    const math::SinCos whole = math::sincos(angle);
    return {whole.cos, whole.sin / root, (DD(1.0) - whole.cos) / alpha, (angle - whole.sin) / (alpha * root)};
  }
  const DD grow = math::exp(angle), fall = DD(1.0) / grow;
  const DD cosh = math::scaled(grow + fall, 0.5), sinh = math::scaled(grow - fall, 0.5);
  return {cosh, sinh / root, (DD(1.0) - cosh) / alpha, (angle - sinh) / (alpha * root)};
}

DD compute_time(const Conic& conic, DD chi) {
  return conic.q * chi + conic.e * compute_anomaly(conic.alpha, chi).u3;
}

Anomaly<double> solve(const Conic& conic, double n) {
  const double alpha = conic.alpha.hi, q = conic.q.hi, e = conic.e.hi, size = std::abs(n);
  if (n == 0.0) return {1.0, 0.0, 0.0, 0.0};
  // The cubic q chi + e chi^3 / 6 lies below the equation of a hyperbola and above that of an ellipse.
  const double s = 3 * size / std::max(e, 1e-3), p = 2 * q / std::max(e, 1e-3);
  const double w = math::cbrt(s + std::sqrt(s * s + p * p * p));
  double chi = w > 0.0 ? w - p / w : 0.0;
  if (!(chi > 0.0)) chi = size / q;
  double low = 0.0, high = std::numeric_limits<double>::infinity();
  if (alpha > 0.0) {
    high = 1.001 * std::numbers::pi / std::sqrt(alpha);
    chi = std::min(chi, 0.999 * high);
  } else if (-alpha * chi * chi > 4.0) {
    const double root = std::sqrt(-alpha), scaled = size * -alpha * root;   // e sinh H - H, and H is not small
    chi = math::asinh((scaled + math::asinh(scaled / e)) / e) / root;
  }
  // Newton's steps within a bracket: the left side grows strictly.
  Anomaly<double> u{};
  double rest = 0.0;
  for (int k = 0; k < 100; ++k) {
    u = compute_anomaly(alpha, chi);
    const double miss = q * chi + e * u.u3 - size, distance = q + e * u.u2;
    (miss > 0.0 ? high : low) = chi;
    rest = -miss / distance;
    if (std::abs(rest) <= 4e-16 * chi) break;
    const double next = chi + rest;
    if (next == chi) break;
    const double before = chi;
    chi = next > low && next < high ? next : std::isfinite(high) ? 0.5 * (low + high) : 2 * chi;
    if (chi == before) break;
  }
  // What lies between two numbers for chi: far out on a hyperbola it matters.
  const double sign = n < 0.0 ? -1.0 : 1.0;
  return {u.u0 - alpha * u.u1 * rest, sign * (u.u1 + u.u0 * rest), u.u2 + u.u1 * rest, sign * (u.u3 + u.u2 * rest)};
}

DD find_chi(const Conic& conic, DD r, DD sigma) {
  const DD& alpha = conic.alpha;
  if (conic.e.hi == 0.0 || sigma.hi == 0.0) {   // a circle begins at its periapsis
    const bool far = conic.e.hi != 0.0 && alpha.hi > 0.0 && (DD(1.0) - alpha * r).hi < 0.0;
    return far ? math::pi<DD>() / math::sqrt(alpha) : DD(0.0);
  }
  if (alpha.hi > 0.0) {
    const DD root = math::sqrt(alpha);
    return math::atan2(root * sigma, DD(1.0) - alpha * r) / root;
  }
  if (alpha.hi < 0.0) {
    const DD root = math::sqrt(-alpha);
    return asinh(root * sigma / conic.e) / root;
  }
  return sigma / conic.e;
}

DD find_chi(const Conic& conic, double nu) {
  const math::SinCos half = math::sincos(DD(0.5 * nu));
  const DD plus = math::sqrt(DD(1.0) + conic.e);
  if (conic.alpha.hi > 0.0) {
    const DD minus = math::sqrt(conic.alpha * conic.q);
    return math::scaled(math::atan2(minus * half.sin, plus * half.cos), 2.0) / math::sqrt(conic.alpha);
  }
  if (!(half.cos.hi > 0.0)) return DD(std::numeric_limits<double>::quiet_NaN());
  const DD s = math::sqrt(conic.q) * half.sin / (plus * half.cos);
  if (conic.alpha.hi == 0.0) return math::scaled(s, 2.0);
  const DD root = math::sqrt(-conic.alpha), x = root * s;
  if (!(std::abs(x.hi) < 1.0)) return DD(std::numeric_limits<double>::quiet_NaN());
  // 2 atanh x = asinh(2 x / (1 - x^2))
  return asinh(math::scaled(x, 2.0) / (DD(1.0) - x * x)) / root;
}

}  // namespace polhode::kepler
