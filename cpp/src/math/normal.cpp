#include "polhode/math/detail/normal.hpp"

#include "polhode/math/detail/dd_functions.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode::math {
namespace {

/// c[0] + c[1] x + ..., never fused, so that the bits are those of every machine.
template <int n>
double horner(const double (&c)[n], double x) {
  double sum = c[n - 1];
  for (int i = n - 2; i >= 0; --i) sum = sum * x + c[i];
  return sum;
}

/// (1/2 - probability) -> quantile, for 0 <= q <= 0.425: q (sqrt(2 pi) + q^2 R(q^2)), with R in powers of 0.425^2 - q^2
/// as in Wichura 1988, Applied Statistics 37, 477. Rational fit at 45 digits, 4e-17.
double middle_quantile(double q) {
  constexpr double up[] = {4.874765941399952, 187.47912749947042, 2700.609010252088, 18130.38721298399,
                           57507.05815081551, 77186.6330715385, 31608.853277229337, 462.6465040238377};
  constexpr double down[] = {1.0, 44.48342124494895, 770.4797072958461, 6586.0824546913545,
                             29107.433430063174, 63744.529248614075, 60173.985435470844, 17072.386760694215};
  const double square = q * q, r = 0.180625 - square;
  return q * 0x1.40d931ff62706p+1 + q * (-1.8328579980459167e-16 + square * (horner(up, r) / horner(down, r)));
}

/// w - z for w = sqrt(-2 log p). Rational fits at 45 digits, 2e-17 of w.
double tail_shortfall(double w) {
  if (w < 6.0) {
    constexpr double up[] = {3.5656571764698475, 27.371783287583593, 39.888478764105706, 18.181695392048546,
                             3.7465463573492648, 0.3038793629771136, 0.006319740433168826, 5.523044573198519e-06};
    constexpr double down[] = {1.0, 12.182021821615818, 28.84589764453299, 22.537405629138323,
                               7.45863511275784, 1.1672581700233036, 0.07016977586234331, 0.001027863499495591};
    return horner(up, w) / horner(down, w);
  }
  constexpr double up[] = {3.241637565488431, 8.871176054320191, 0.9260980870411997,
                           -0.7406415577044138, -0.11868497501314706, -0.005105497306862818,
                           -6.794901636981072e-05, -2.186516798372637e-07, -2.5216463722203694e-11};
  constexpr double down[] = {1.0, 5.5192130837167985, 3.695452587981693,
                             -0.3029823282454883, -0.2961590620261687, -0.03144772213056586,
                             -0.0010479806884526686, -1.1139895553218263e-05, -2.7584536822840167e-08};
  return horner(up, w) / horner(down, w);
}

/// exp(-x^2 / 2) / sqrt(2 pi), |x| <= 37.
DD normal_density(double x) {
  return exp_dd(scaled(two_prod(x, x), -0.5)) * DD(0.3989422804014327, -2.4923272022777433e-17);
}

/// x + x^3 / 3 + x^5 / (3 5) + ..., 0 <= x <= 3: the integral of the density over [0, x], over the density.
DD normal_series(double x) {
  const DD square = two_prod(x, x);
  DD term(x), sum(x);
  for (int n = 3; term.hi > 0x1p-110 * sum.hi; n += 2) {
    term = term * square / DD(static_cast<double>(n));
    sum = sum + term;
  }
  return sum;
}

/// x + 1 / (x + 2 / (x + 3 / ...)), x > 3: the density over the tail (Laplace's continued fraction).
DD tail_fraction(double x) {
  DD value(x);
  for (int n = 400; n >= 1; --n) value = DD(x) + DD(static_cast<double>(n)) / value;
  return value;
}

}  // namespace

double upper_normal_quantile(double p) {
  if (p >= 0.075) return middle_quantile(0.5 - p);
  const DD w = sqrt(DD(-2.0 * log(p)));
  return w.hi - (tail_shortfall(w.hi) - w.lo);
}

double upper_normal_tail(double x) {
  const double size = abs(x);
  DD tail(0.0);
  if (size <= 3.0) tail = DD(0.5) - normal_density(size) * normal_series(size);
  else if (size <= 37.0) tail = normal_density(size) / tail_fraction(size);
  return x < 0.0 ? (DD(1.0) - tail).hi : tail.hi;
}

}  // namespace polhode::math
