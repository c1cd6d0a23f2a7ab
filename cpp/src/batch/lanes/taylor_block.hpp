#pragma once

#include "batch/lanes/lane_state.hpp"
#include "polhode/ode/series.hpp"
#include "method/series/series_terms.hpp"

namespace polhode {

/// Eight bodies stepped by Taylor series, each with its own constants.
struct TaylorBlock : LaneState {
  // common to all lanes
  int order = 0;
  double rtol = 0.0, atol = 0.0;
  bool damped = false, balanced = false;   ///< balanced: corrected to the values `kept` after each step

  // constants of a body: SeriesTerms by columns, vectors fixed in space, invariants of a free body (BodySeries)
  alignas(64) Row to_rates = {};
  Row product[3] = {}, product_low[3] = {}, torque[3] = {}, damping[3][3] = {}, pull[2][3][3] = {}, tidal[2][3] = {};
  Row orbit_rate = {}, orbit_cos = {}, orbit_sin = {}, space[2][3] = {}, balance = {}, kept[2] = {}, kept_low[2] = {};

  // state now, then before the last step: (r0, r1, r2, - | x, y, z, w), or a vector in place of the quaternion
  Row y[8] = {}, carry[8] = {}, time_low = {}, unit = {};
  Row y_old[8] = {}, carry_old[8] = {}, time_old = {}, time_old_low = {}, unit_old = {};

  // Taylor coefficients in powers of t / unit, rates times unit: of y, of (v - u, w1, w3), of the vectors
  Row c[8][ode::most_series_order + 1] = {}, side[3][ode::most_series_order + 1] = {},
                                    vector[4][3][ode::most_series_order + 1] = {};
};

struct TaylorKernels {
  explicit operator bool() const { return step != nullptr; }

  void (*step)(TaylorBlock& block);
  /// y within the last step, s units of time after its start.
  void (*sample)(const TaylorBlock& block, const double* s, double (*y)[LaneState::width]);
};

/// With `attitude` the quaternion is integrated; without, the rates and at most one fixed vector. Null where the
/// compiler could not build the level.
TaylorKernels baseline_taylor_lanes(const SeriesTerms& terms, bool attitude);
TaylorKernels avx2_taylor_lanes(const SeriesTerms& terms, bool attitude);
TaylorKernels avx512_taylor_lanes(const SeriesTerms& terms, bool attitude);

}  // namespace polhode
