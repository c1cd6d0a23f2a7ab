#pragma once

#include "polhode/ode/series.hpp"
#include "polhode/solve/series_terms.hpp"

namespace polhode {

/// What became of a lane's step.
enum LaneOutcome { lane_stepped, lane_arrived, lane_not_finite, lane_underflow };

/// Eight bodies side by side, each with its own constants, time, step and end: row[i] belongs to body i. Nothing that
/// is done here looks from one lane to another, so a body's bits do not depend on its neighbours.
struct alignas(64) LaneBlock {
  static constexpr int width = 8;
  using Row = double[width];

  // of all eight
  int order = 0;
  double rtol = 0.0, atol = 0.0;
  bool damped = false, balanced = false;   ///< balanced: brought back to `kept` after each step

  // constants of a body: SeriesTerms by columns, vectors fixed in space, what a free body keeps (BodySeries)
  alignas(64) Row to_rates = {};   // a row is a line of the cache
  Row product[3] = {}, product_low[3] = {}, torque[3] = {}, damping[3][3] = {}, pull[2][3][3] = {}, tidal[2][3] = {};
  Row orbit_rate = {}, orbit_cos = {}, orbit_sin = {}, space[2][3] = {}, balance = {}, kept[2] = {}, kept_low[2] = {};

  // state before a step and after it: (r0, r1, r2, - | x, y, z, w), or with a vector in place of the quaternion
  Row y[8] = {}, carry[8] = {}, time = {}, time_low = {}, unit = {}, t_end = {};
  Row y_old[8] = {}, carry_old[8] = {}, time_old = {}, time_old_low = {}, unit_old = {};
  Row outcome = {};

  // Taylor coefficients in powers of t / unit, rates times unit: of y, of (v - u, w1, w3), of vectors
  Row c[8][ode::most_series_order + 1] = {}, side[3][ode::most_series_order + 1] = {}, vector[4][3][ode::most_series_order + 1] = {};
};

struct LaneKernels {
  void (*step)(LaneBlock& block);
  /// y within the last step, s units of time after its begin.
  void (*sample)(const LaneBlock& block, const double* s, double (*y)[LaneBlock::width]);
};

/// `attitude`: the quaternion is carried; else nothing but the rates, or one fixed vector beside them.
LaneKernels find_lane_kernels(const SeriesTerms& terms, bool attitude);

/// Null where the compiler could not build the level.
LaneKernels baseline_lane_kernels(const SeriesTerms& terms, bool attitude);
LaneKernels avx2_lane_kernels(const SeriesTerms& terms, bool attitude);
LaneKernels avx512_lane_kernels(const SeriesTerms& terms, bool attitude);

}  // namespace polhode
