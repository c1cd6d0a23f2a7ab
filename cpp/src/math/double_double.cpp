#include "polhode/math/double_double.hpp"

#include <limits>

// Taylor series after reduction; the reciprocal factorials are the only tables.
namespace polhode::math {
namespace {

const DD inverse_factorial[] = {
    {1.0, 0.0},
    {1.0, 0.0},
    {0.5, 0.0},
    {0.16666666666666666, 9.25185853854297e-18},
    {0.041666666666666664, 2.3129646346357427e-18},
    {0.008333333333333333, 1.1564823173178714e-19},
    {0.001388888888888889, -5.300543954373577e-20},
    {0.0001984126984126984, 1.7209558293420705e-22},
    {2.48015873015873e-05, 2.1511947866775882e-23},
    {2.7557319223985893e-06, -1.858393274046472e-22},
    {2.755731922398589e-07, 2.3767714622250297e-23},
    {2.505210838544172e-08, -1.448814070935912e-24},
    {2.08767569878681e-09, -1.20734505911326e-25},
    {1.6059043836821613e-10, 1.2585294588752098e-26},
    {1.1470745597729725e-11, 2.0655512752830745e-28},
    {7.647163731819816e-13, 7.03872877733453e-30},
    {4.779477332387385e-14, 4.399205485834081e-31},
    {2.8114572543455206e-15, 1.6508842730861433e-31},
    {1.5619206968586225e-16, 1.1910679660273754e-32},
    {8.22063524662433e-18, 2.2141894119604265e-34},
    {4.110317623312165e-19, 1.4412973378659527e-36},
    {1.9572941063391263e-20, -1.3643503830087908e-36},
    {8.896791392450574e-22, -7.911402614872376e-38},
    {3.868170170630684e-23, -8.843177655482344e-40},
    {1.6117375710961184e-24, -3.6846573564509766e-41},
    {6.446950284384474e-26, -1.9330404233703465e-42},
    {2.4795962632247976e-27, -1.2953730964765229e-43},
    {9.183689863795546e-29, 1.4303150396787322e-45},
};

constexpr double half_pi_third = -1.4973849048591698e-33;  // what pi/2 leaves beyond its double-double

/// The sum of (sign x2)^j / (first + 2 j)! for first + 2 j <= last.
DD series(DD x2, int first, int last, double sign) {
  DD sum = inverse_factorial[last];
  for (int n = last - 2; n >= first; n -= 2) sum = sum * x2 * DD(sign) + inverse_factorial[n];
  return sum;
}

}  // namespace

SinCos sincos(DD angle) {
  const DD half_pi{1.5707963267948966, 6.123233995736766e-17};
  const double n = rint(angle.hi / half_pi.hi);
  const DD n_high = two_prod(n, half_pi.hi), n_low = two_prod(n, half_pi.lo);
  const DD r = ((angle - n_high) - n_low) - DD(n * half_pi_third);
  const DD r2 = r * r;
  const DD s = r * series(r2, 1, 27, -1.0), c = series(r2, 0, 26, -1.0);
  const double turn = n - 4.0 * std::floor(n / 4.0);
  if (turn == 0.0) return {s, c};
  if (turn == 1.0) return {c, -s};
  if (turn == 2.0) return {-s, -c};
  return {-c, s};
}

DD exp(DD x) {
  if (x.hi > 709.7) return DD(std::numeric_limits<double>::infinity());
  if (!(x.hi > -746.0)) return DD(0.0);
  const DD ln2{0.6931471805599453, 2.3190468138462996e-17};
  const double n = rint(x.hi / ln2.hi);
  const DD r = scaled(x - ln2 * DD(n), 0x1p-8);  // |r| < 1.4e-3
  DD e = inverse_factorial[10];
  for (int i = 9; i >= 1; --i) e = e * r + inverse_factorial[i];
  e = e * r;                                              // e^r - 1, then (e^r)^2 - 1 = 2 e + e^2
  for (int i = 0; i < 8; ++i) e = scaled(e, 2.0) + e * e;
  e = e + DD(1.0);
  return {std::ldexp(e.hi, static_cast<int>(n)), std::ldexp(e.lo, static_cast<int>(n))};
}

DD log(DD x) {
  const DD ln2{0.6931471805599453, 2.3190468138462996e-17};
  int k = 0;
  std::frexp(x.hi, &k);
  const DD m{std::ldexp(x.hi, -k), std::ldexp(x.lo, -k)};
  // Near 1 from either side the two terms would cancel: keep the exponent out there.
  if (x.hi > 0.5 && x.hi < 2.0) {
    const DD y = DD(std::log(x.hi));
    const DD d = x * exp(-y) - DD(1.0);  // |d| < 1e-16
    return y + (d - d * d * DD(0.5));
  }
  const DD y = DD(std::log(m.hi));
  const DD d = m * exp(-y) - DD(1.0);
  return (y + (d - d * d * DD(0.5))) + ln2 * DD(static_cast<double>(k));
}

DD atan2(DD y, DD x) {
  const double guess = std::atan2(y.hi, x.hi);
  const SinCos g = sincos(DD(guess));
  const DD across = y * g.cos - x * g.sin, along = x * g.cos + y * g.sin;
  const DD d = across / along;  // tan of what is missing, below 1e-15: its cube is nothing
  return DD(guess) + d;
}

}  // namespace polhode::math
