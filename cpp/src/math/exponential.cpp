#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "polhode/math/detail/dd_functions.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode::math {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
constexpr double largest_exponent = 710.0, least_exponent = -746.0;   // e^x overflows above, and is 0 below

DD ln2() { return {0.6931471805599453, 2.3190468138462996e-17}; }

/// m 2^n of 1/2 < m < 2, rounded once, below the normal numbers too.
double round_scaled(DD m, int n) {
  if (n >= -1020) return std::ldexp(m.hi, n);
  const double place = std::ldexp(1.0, -1022 - n);   // where a number's last bit is 2^-1074 2^-n
  if (std::isinf(place)) return 0.0;
  const DD sum = fast_two_sum(place, m.hi);
  return std::ldexp((sum.hi + (sum.lo + m.lo)) - place, n);
}

/// e^x for least_exponent <= x <= largest_exponent.
double exp_of(DD x) {
  const double n = rint(x.hi * 1.4426950408889634);
  return round_scaled(expm1_dd(x - ln2() * DD(n)) + DD(1.0), static_cast<int>(n));
}

/// x = m 2^n, 0.7 < m < 1.42, for 0 < x < infinity.
struct Split {
  double m;
  int n;

  explicit Split(double x) {
    m = std::frexp(x, &n);
    if (m < 0.7071067811865476) m += m, --n;
  }
};

/// log(m) / 2, 0.7 < m < 1.42, relative error about 1e-15: the series of the inverse hyperbolic tangent.
double half_log(double m) {
  constexpr double c[] = {1.0,      1.0 / 3,  1.0 / 5,  1.0 / 7,  1.0 / 9,
                          1.0 / 11, 1.0 / 13, 1.0 / 15, 1.0 / 17, 1.0 / 19};
  const double s = (m - 1.0) / (m + 1.0), z = s * s, z2 = z * z, z4 = z2 * z2;
  const double low = (c[0] + c[1] * z) + (c[2] + c[3] * z) * z2, high = (c[4] + c[5] * z) + (c[6] + c[7] * z) * z2;
  return s * (low + (high + (c[8] + c[9] * z) * z4) * z4);
}

/// For 0 < x < infinity: a guess, and what remains to the exponential.
DD log_of(double x) {
  const Split split(x);
  const double guess = 2.0 * half_log(split.m);
  const DD residual = DD(split.m - 1.0) + DD(split.m) * expm1_dd(DD(-guess));
  const DD log_m = DD(guess) + (residual - scaled(residual * residual, 0.5));
  return split.n == 0 ? log_m : ln2() * DD(static_cast<double>(split.n)) + log_m;
}

}  // namespace

double exp(double x) {
  if (!(x < largest_exponent)) return x + infinity;
  return x < least_exponent ? 0.0 : exp_of(x);
}

double expm1(double x) {
  if (abs(x) < 0x1p-54) return x;
  if (abs(x) < 0.35) return expm1_dd(DD(x)).hi;
  if (!(x < 100.0)) return exp(x);
  if (x < -100.0) return -1.0;
  return (exp_dd(DD(x)) - DD(1.0)).hi;
}

double log(double x) {
  if (!(x > 0.0)) return x == 0.0 ? -infinity : nan;
  return x < infinity ? log_of(x).hi : x;
}

double asinh(double x) {
  const double size = abs(x);
  if (size < 1e-9 || !(size < infinity)) return x;   // x - x^3 / 6
  if (size > 1e100) return copysign((log_of(size) + ln2()).hi, x);
  // log(1 + z), z = x + x^2 / (1 + sqrt(1 + x^2)), from the logarithm of the rounded sum.
  const DD square = two_prod(size, size), z = DD(size) + square / (DD(1.0) + sqrt(DD(1.0) + square));
  const double sum = (DD(1.0) + z).hi;
  const DD lost = (two_diff(1.0, sum) + z) / DD(sum);
  return copysign((log_of(sum) + (lost - scaled(lost * lost, 0.5))).hi, x);
}

double cbrt(double x) {
  if (x == 0.0 || !(abs(x) < infinity)) return x;
  int n = 0;
  double m = std::frexp(abs(x), &n);
  for (; n % 3 != 0; ++n) m *= 0.5;
  const double guess = fast_exp2(fast_log2(m) * (1.0 / 3));
  const DD cube = two_prod(guess, guess) * DD(guess);
  const DD root = DD(guess) + (DD(m) - cube) / (DD(3.0) * two_prod(guess, guess));
  return copysign(std::ldexp(root.hi, n / 3), x);
}

double pow(double x, double y) {
  if (y == 0.0 || x == 1.0) return 1.0;
  if (std::isnan(x) || std::isnan(y)) return x + y;
  const double size = abs(x);
  const bool whole = rint(y) == y, odd = whole && abs(y) < 0x1p53 && std::fmod(y, 2.0) != 0.0;
  if (size == 0.0 || std::isinf(size) || std::isinf(y)) {
    if (size == 1.0) return 1.0;
    const double result = (size > 1.0) == (y > 0.0) ? infinity : 0.0;
    return odd && std::signbit(x) ? -result : result;
  }
  if (x < 0.0 && !whole) return nan;
  const DD log = log_of(size);
  const double rough = log.hi * y;
  double result;
  if (!(abs(rough) < 0x1p-60)) {
    if (rough > largest_exponent) result = infinity;
    else result = rough < least_exponent ? 0.0 : exp_of(log * DD(y));
  } else {
    result = 1.0;
  }
  return odd && x < 0.0 ? -result : result;
}

double fast_log2(double x) {
  if (!(x > 0.0 && x < infinity)) return x == 0.0 ? -infinity : x > 0.0 ? x : nan;
  const Split split(x);
  return split.n + half_log(split.m) * 2.8853900817779268;   // 2 / ln 2
}

double fast_exp2(double x) {
  if (!(x < 1025.0)) return x + infinity;
  if (x < -1080.0) return 0.0;
  constexpr double c[] = {1.0,         1.0,          1.0 / 2,       1.0 / 6,        1.0 / 24,
                          1.0 / 120,   1.0 / 720,    1.0 / 5040,    1.0 / 40320,    1.0 / 362880,
                          1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600};
  const double n = rint(x), r = (x - n) * 0.6931471805599453, r2 = r * r, r4 = r2 * r2;
  const double low = (c[0] + c[1] * r) + (c[2] + c[3] * r) * r2, middle = (c[4] + c[5] * r) + (c[6] + c[7] * r) * r2;
  const double high = ((c[8] + c[9] * r) + (c[10] + c[11] * r) * r2) + c[12] * r4;
  const double e = low + (middle + high * r4) * r4;
  if (n >= -1022.0 && n <= 1023.0) return e * power_of_two(n);
  return std::ldexp(e, static_cast<int>(n));
}

double fast_log(double x) { return fast_log2(x) * 0.6931471805599453; }

double fast_pow(double x, double y) { return fast_exp2(y * fast_log2(x)); }

double power(double x, int n) {
  double result = 1.0;
  for (unsigned left = static_cast<unsigned>(n < 0 ? -n : n); left != 0; left >>= 1, x *= x)
    if ((left & 1) != 0) result *= x;
  return n < 0 ? 1.0 / result : result;
}

}  // namespace polhode::math
