#pragma once

#include "batch/lanes/pass.hpp"
#include "batch/lanes/taylor_block.hpp"
#include "polhode/math/detail/double_double.hpp"

// What every set of torques shares: the step length, the sum of the series, and the corrections after a step.
namespace polhode::POLHODE_ISA {

using WideDD = math::DoubleDouble<Wide>;

/// log2(x) to 1e-3 (ode/step_control.hpp), for 2^-1022 <= x < 2^1023.
POLHODE_INLINE Wide rough_log2(Wide x) {
  const Wide exponent = exponent_of_power(power_of_two_below(x)), m = x * power_of_two(-exponent) - Wide(1.0);
  return madd(m, madd(m, madd(m, Wide(0.1548), Wide(-0.5797)), Wide(1.4249)), exponent);
}

/// 2^x to 1e-3, for |x| <= 1000.
POLHODE_INLINE Wide rough_exp2(Wide x) {
  const Wide n = rint(x), f = x - n;
  return power_of_two(n) * madd(f, madd(f, madd(f, Wide(0.0558), Wide(0.2402)), Wide(0.6931)), Wide(1.0));
}

/// The sum of the series at s, without its first coefficient and with the carry.
POLHODE_INLINE void sum_series(const TaylorBlock& b, Pass pass, Wide s, Wide unit, const Row (&carry)[8],
                               Wide (&out)[8]) {
  constexpr int used[7] = {0, 1, 2, 4, 5, 6, 7};
  Wide sum[7];
  for (int i = 0; i < 7; ++i) sum[i] = pass.load(b.c[used[i]][b.order]);
  for (int k = b.order - 1; k > 0; --k)
    for (int i = 0; i < 7; ++i) sum[i] = madd(sum[i], s, pass.load(b.c[used[i]][k]));
  const Wide per_unit = s / unit;   // the coefficients of the rates are multiplied by the unit, the carry is not
  out[3] = Wide(0.0);
  for (int i = 0; i < 7; ++i) out[used[i]] = madd(sum[i], i < 3 ? per_unit : s, pass.load(carry[used[i]]));
}

/// log2 of the step length in units of the lane's time, by the rule of ode::Taylor (Jorba & Zou 2005). It is for one
/// block of the state, whose first `heads` coefficients give its size. size: of rows 0, 1, 2, order - 1, order.
template <int heads>
POLHODE_INLINE Wide log_step(const Wide (&size)[5], Wide tolerance, int order) {
  const Wide zero(0.0), none(1100.0);
  Wide largest = size[0];
  for (int j = 1; j < heads; ++j) largest = larger(largest, size[j]);
  largest = select(largest > zero, largest, larger(size[3], size[4]));
  const Wide scale = power_of_two(-exponent_of_power(power_of_two_below(largest)));
  Wide head[heads];
  for (int j = 0; j < heads; ++j) head[j] = select(size[j] > zero, rough_log2(size[j] * scale), Wide(-1e4));
  const Wide part = (rough_log2(tolerance) - Wide(2.0)) * Wide(1.0 / (order - 1));
  Wide least = none;
  for (int m = order - 1; m <= order; ++m) {
    const Wide tail = size[3 + m - (order - 1)], log_tail = rough_log2(tail * scale);
    Wide radius = (head[0] - log_tail) * Wide(1.0 / m);
    for (int j = 1; j < heads; ++j) radius = larger(radius, (head[j] - log_tail) * Wide(1.0 / (m - j)));
    radius = select(tail > zero, radius, none);
    least = select(radius < least, radius, least);
  }
  return least + select(part < zero, part, zero);
}

/// One Newton step that brings a free body back to its energy and |L|: BodySeries::correct_rates in lanes.
POLHODE_INLINE void balance_rates(const TaylorBlock& b, Pass pass, Wide (&y)[8], Wide (&carry)[8]) {
  const Wide zero(0.0), balance = pass.load(b.balance);
  const WideDD u(y[0], carry[0]), v(y[1], carry[1]), w(y[2], carry[2]);
  const WideDD kept[2] = {{pass.load(b.kept[0]), pass.load(b.kept_low[0])},
                          {pass.load(b.kept[1]), pass.load(b.kept_low[1])}};
  const Wide uu = y[0] * y[0], vv = y[1] * y[1], ww = y[2] * y[2], uv = y[0] * y[1], sum = uu + vv;
  const Wide split = select(sum > zero, (uu - vv) / sum, zero);
  const Wide scaling = select(abs(uv) > Wide(1e-250), Wide(-0.5) * (u * v - kept[0]).hi / uv, zero);
  const Wide residual = (WideDD(balance) * (u * u + v * v) + w * w - kept[1]).hi + Wide(2.0) * balance * sum * scaling;
  const Wide slope = Wide(2.0) * (balance * (uu - vv) * split + ww);
  // Where the energy is extreme for this u v, its slope vanishes and it cannot be corrected.
  const Wide step = select(slope > Wide(1e-3) * (balance * sum + ww), -residual / slope, zero), shift = step * split;
  const Wide change[3] = {y[0] * (scaling + shift), y[1] * (scaling - shift), y[2] * step};
  for (int i = 0; i < 3; ++i) {
    const WideDD corrected = math::two_sum(y[i], carry[i] + select(abs(scaling) < Wide(0.1), change[i], zero));
    y[i] = corrected.hi, carry[i] = corrected.lo;
  }
}

/// Brings the attitude back to |q| = 1, as BodySeries::correct does.
POLHODE_INLINE void balance_attitude(Wide (&y)[8], Wide (&carry)[8]) {
  Wide norm(0.0), cross(0.0);
  for (int i = 4; i < 8; ++i) norm = madd(y[i], y[i], norm), cross = madd(y[i], carry[i], cross);
  const Wide residual = Wide(0.5) * (Wide(1.0) - norm) - cross;
  for (int i = 4; i < 8; ++i) {
    const WideDD sum = math::two_sum(y[i], madd(residual, y[i], carry[i]));
    y[i] = sum.hi, carry[i] = sum.lo;
  }
}

/// Makes a step with the coefficients in the block. `rates`: those of rows 0, 1, 2, order - 1, order, for their sizes.
template <bool attitude, bool vector>
POLHODE_INLINE void finish_step(TaylorBlock& b, Pass pass, const Wide (&rates)[5][3]) {
  const Wide zero(0.0), unit = pass.load(b.unit);
  const int row[5] = {0, 1, 2, b.order - 1, b.order};
  Wide size[5], probe(0.0);   // the probe stays zero while all is finite; comparisons would miss a NaN
  for (int k = 0; k < 5; ++k) {
    for (const Wide& w : rates[k]) probe = madd(zero, w, probe);
    size[k] = larger(larger(abs(rates[k][0]), abs(rates[k][1])), abs(rates[k][2]));
  }
  const auto tolerance = [&](Wide s) { return Wide(b.rtol) + select(s > zero, Wide(b.atol) / s, zero); };
  Wide least = log_step<3>(size, tolerance(size[0] / unit), b.order);
  if constexpr (attitude || vector) {
    for (int k = 0; k < 5; ++k) {
      size[k] = zero;
      for (int i = 4; i < (attitude ? 8 : 7); ++i) {
        const Wide x = pass.load(b.c[i][row[k]]);
        probe = madd(zero, x, probe), size[k] = larger(size[k], abs(x));
      }
    }
    const Wide other = log_step<1>(size, tolerance(size[0]), b.order);
    least = select(other < least, other, least);
  }
  least = select(least > Wide(1000.0), Wide(1000.0), larger(least, Wide(-1000.0)));
  const auto finite = probe == zero;
  const Wide reach = rough_exp2(least) * unit, time = pass.load(b.time), time_low = pass.load(b.time_low),
             t_end = pass.load(b.t_end);
  const Wide rest = (t_end - time) - time_low;
  const auto last = abs(rest) <= reach * Wide(1.01);
  const Wide h = select(last, rest, copysign(reach, rest));
  const auto moves = abs(h) > Wide(0x1p-49) * abs(time);   // 8 units of rounding
  const Wide outcome = select(last, Wide(lane_arrived), select(moves, Wide(lane_stepped), Wide(lane_underflow)));
  pass.store(b.outcome, select(finite, outcome, Wide(lane_not_finite)));

  Wide increment[8], y[8], carry[8];
  sum_series(b, pass, h / unit, unit, b.carry, increment);
  for (int i = 0; i < 8; ++i) {
    const WideDD sum = math::two_sum(pass.load(b.y[i]), increment[i]);
    y[i] = sum.hi, carry[i] = sum.lo;
  }
  if constexpr (!attitude && !vector)
    for (int i = 4; i < 8; ++i) y[i] = carry[i] = zero;
  if (b.balanced) balance_rates(b, pass, y, carry);
  if constexpr (attitude) balance_attitude(y, carry);
  for (int i = 0; i < 8; ++i) {
    const Wide y_old = pass.load(b.y[i]), carry_old = pass.load(b.carry[i]);
    pass.store(b.y_old[i], y_old), pass.store(b.carry_old[i], carry_old);
    pass.store(b.y[i], select(finite, y[i], y_old)), pass.store(b.carry[i], select(finite, carry[i], carry_old));
  }
  const WideDD after = select(last, WideDD(t_end), WideDD(time, time_low) + h);
  pass.store(b.time_old, time), pass.store(b.time_old_low, time_low), pass.store(b.unit_old, unit);
  pass.store(b.time, select(finite, after.hi, time)), pass.store(b.time_low, select(finite, after.lo, time_low));
  // A step shortened by t_end says little about the next one. A step that is not finite is tried in a smaller unit.
  const Wide next = select(reach < Wide(0x1p900), larger(reach, Wide(0x1p-900)), Wide(0x1p900));
  pass.store(b.unit, select(finite, power_of_two_below(next), larger(unit * Wide(0x1p-16), Wide(0x1p-900))));
}

inline void sample_lanes(const TaylorBlock& b, const double* s, double (*out)[TaylorBlock::width]) {
  for (int at = 0; at < TaylorBlock::width; at += Wide::width) {
    const Pass pass{at};
    Wide increment[8];
    sum_series(b, pass, Wide::load(s + at), pass.load(b.unit_old), b.carry_old, increment);
    for (int i = 0; i < 8; ++i) (pass.load(b.y_old[i]) + increment[i]).store(out[i] + at);
  }
}

}  // namespace polhode::POLHODE_ISA
