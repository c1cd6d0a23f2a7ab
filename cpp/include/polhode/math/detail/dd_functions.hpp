#pragma once

#include "polhode/math/detail/atan2.hpp"
#include "polhode/math/detail/double_double.hpp"

// Transcendental functions in double-double, without branches: the bodies of sincos, exp, log and atan2 for any number
// type. Taylor series after reduction; relative error about 1e-31.
namespace polhode::math {

/// 1 / n!, n = 0 ... 27, to 106 bits.
inline constexpr double inverse_factorial_dd[28][2] = {
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

template <class T>
POLHODE_INLINE DoubleDouble<T> inverse_factorial(int n) {
  return {T(inverse_factorial_dd[n][0]), T(inverse_factorial_dd[n][1])};
}

template <class T>
struct SinCosOf {
  DoubleDouble<T> sin, cos;
};

template <class T>
inline SinCosOf<T> sincos_dd(DoubleDouble<T> angle) {
  using N = DoubleDouble<T>;
  const T n = rint(angle.hi * T(0.6366197723675814));
  const N r = ((angle - two_prod(n, T(1.5707963267948966))) - two_prod(n, T(6.123233995736766e-17))) -
              N(n * T(-1.4973849048591698e-33));  // pi/2 in three parts
  const N minus_r2 = -(r * r);
  N s = inverse_factorial<T>(27), c = inverse_factorial<T>(26);
  for (int i = 25; i >= 1; i -= 2) {
    s = s * minus_r2 + inverse_factorial<T>(i);
    c = c * minus_r2 + inverse_factorial<T>(i - 1);
  }
  s = s * r;
  const T quadrant = n - T(4.0) * rint(T(0.25) * n), size = abs(quadrant), even = T(1.0) - size;
  const auto odd = size == T(1.0);
  return {select(odd, scaled(c, quadrant), scaled(s, even)), select(odd, -scaled(s, quadrant), scaled(c, even))};
}

/// e^r - 1 with its relative accuracy, |r| < 0.36.
template <class T>
inline DoubleDouble<T> expm1_dd(DoubleDouble<T> r) {
  using N = DoubleDouble<T>;
  r = scaled(r, T(0x1p-8));
  N e = inverse_factorial<T>(10);
  for (int i = 9; i >= 1; --i) e = e * r + inverse_factorial<T>(i);
  e = e * r;  // then (e^r)^2 - 1 = 2 e + e^2
  for (int i = 0; i < 8; ++i) e = twice(e) + e * e;
  return e;
}

/// |x| < 700.
template <class T>
inline DoubleDouble<T> exp_dd(DoubleDouble<T> x) {
  using N = DoubleDouble<T>;
  const T n = rint(x.hi * T(1.4426950408889634));
  const N r = x - N(T(0.6931471805599453), T(2.3190468138462996e-17)) * N(n);
  return scaled(expm1_dd(r) + N(1.0), power_of_two(n));
}

/// 1e-290 < x < 1e290. A plain logarithm to 4e-13, then one step of third order.
template <class T>
inline DoubleDouble<T> log_dd(DoubleDouble<T> x) {
  using N = DoubleDouble<T>;
  const T low = power_of_two_below(x.hi);
  const auto above = x.hi > T(1.4142135623730951) * low;
  const T unit = select(above, low + low, low), m = x.hi / unit;
  const T s = (m - T(1.0)) / (m + T(1.0)), s2 = s * s;
  constexpr double c[] = {2.0, 2.0 / 3, 2.0 / 5, 2.0 / 7, 2.0 / 9, 2.0 / 11, 2.0 / 13};
  // log2(unit) by the trick of adding: its exponent field read as a number.
  const T guess = madd(exponent_of_power(unit), T(0.6931471805599453), s * polynomial(c, s2));
  const N d = x * exp_dd(N(-guess)) - N(1.0);
  return N(guess) + (d - scaled(d * d, T(0.5)) + d * d * d * N(T(1.0 / 3)));
}

/// (x, y) not both 0; in (-pi, pi].
template <class T>
inline DoubleDouble<T> atan2_dd(DoubleDouble<T> y, DoubleDouble<T> x) {
  using N = DoubleDouble<T>;
  const N guess(T(6.283185307179586) * atan2_cycles(y.hi, x.hi));
  const SinCosOf<T> g = sincos_dd(guess);
  return guess + (y * g.cos - x * g.sin) / (x * g.cos + y * g.sin);  // tan of what is missing: its cube is nothing
}

}  // namespace polhode::math
