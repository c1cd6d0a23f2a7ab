#pragma once

#include "exact/sensitivity/series.hpp"
#include "polhode/math/detail/double_double.hpp"

// The power series, with columns in the lanes of `Wide`.
namespace polhode::POLHODE_ISA {

using exact::ColumnSeries, exact::SeriesStart, exact::SeriesSums, exact::series_order, exact::series_slots;

/// The coefficients of the terms of a column without d omega: of omega_2 omega_3, omega_3 omega_1, omega_1 omega_2,
/// the squares, and omega' about each axis.
struct SeriesSources {
  alignas(64) double of[3][9][series_slots] = {};

  POLHODE_INLINE explicit SeriesSources(const SeriesStart& s) {
    for (int i = 0; i < 3; ++i) {
      const int b = (i + 1) % 3, c = (i + 2) % 3, slot = 3 + i;
      // J_i in the equations of the axes i, b and c
      of[i][6 + i][slot] = -1.0, of[b][b][slot] = -1.0, of[c][c][slot] = 1.0;
      // Axes rotated about axis i: dJ has the elements (b, c) and (c, b). With omega' = gap / I times a product, two
      // terms of a row are one, whose factor cancels for slender bodies. It is 0 for a plate across axis i.
      const math::DD others = math::two_sum(s.I[b], s.I[c]);
      const double gap = s.I[b] - s.I[c], left = (others.hi - s.I[i]) + others.lo;
      const int rotated = 8 + i;
      of[b][c][rotated] = gap * left / s.I[c];
      of[c][b][rotated] = -gap * left / s.I[b];
      of[i][3 + b][rotated] = -gap, of[i][3 + c][rotated] = gap;
    }
  }
};

inline void make_series(const SeriesStart& s, bool axes, int order, ColumnSeries& series) {
  constexpr int width = Wide::width;
  series.slots = axes ? 16 : 8;
  double w[series_order + 1][3], squares[series_order + 1][9];
  const double gap[3] = {s.I[1] - s.I[2], s.I[2] - s.I[0], s.I[0] - s.I[1]};
  for (int a = 0; a < 3; ++a) w[0][a] = s.w[a];
  for (int n = 0; n <= order; ++n) {
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      double product = 0.0, square = 0.0;
      for (int j = 0; j <= n; ++j) product = product + w[j][b] * w[n - j][c], square = square + w[j][a] * w[n - j][a];
      squares[n][a] = product, squares[n][3 + a] = square;
      const double slope = gap[a] / s.I[a] * product;
      squares[n][6 + a] = slope;
      if (n < order) w[n + 1][a] = slope / (n + 1.0);
      series.square[n][a] = series.square[n][3 + a] = 0.0;
    }
  }
  for (int n = 1; n < order; ++n)
    for (int a = 0; a < 6; ++a) series.square[n + 1][a] = -squares[n][(3 + a) % 6] / (n + 1.0);

  const SeriesSources sources(s);
  for (int slot = 0; slot < series.slots; ++slot) {
    for (int a = 0; a < 3; ++a) series.omega[0][a][slot] = slot == a ? 1.0 : 0.0, series.theta[0][a][slot] = 0.0;
  }
  for (int lane = 0; lane < series.slots; lane += width) {
    for (int n = 0; n < order; ++n) {
      const Wide inverse(1.0 / (n + 1.0));
      for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        Wide sum(0.0), rotated = Wide::load(series.omega[n][a] + lane);
        for (int j = 0; j <= n; ++j) {
          const Wide wb(w[n - j][b]), wc(w[n - j][c]);
          sum = madd(Wide::load(series.omega[j][b] + lane), wc, sum);
          sum = madd(Wide::load(series.omega[j][c] + lane), wb, sum);
          rotated = madd(-wb, Wide::load(series.theta[j][c] + lane), rotated);
          rotated = madd(wc, Wide::load(series.theta[j][b] + lane), rotated);
        }
        Wide source(0.0);
        for (int k = 0; k < 9; ++k)
          source = madd(Wide::load(sources.of[a][k] + lane), Wide(squares[n][k]), source);
        const Wide next = madd(Wide(gap[a]), sum, source) / Wide(s.I[a]) * inverse;
        next.store(series.omega[n + 1][a] + lane);
        (rotated * inverse).store(series.theta[n + 1][a] + lane);
      }
    }
  }
}

inline void sum_series(const ColumnSeries& series, double t, int order, bool attitudes, SeriesSums& sums) {
  const Wide x(t);
  for (int lane = 0; lane < series.slots; lane += Wide::width) {
    for (int a = 0; a < 3; ++a) {
      Wide omega = Wide::load(series.omega[order][a] + lane);
      for (int n = order - 1; n >= 0; --n) omega = madd(omega, x, Wide::load(series.omega[n][a] + lane));
      omega.store(sums.omega[a] + lane);
      if (!attitudes) continue;
      Wide theta = Wide::load(series.theta[order][a] + lane);
      for (int n = order - 1; n >= 0; --n) theta = madd(theta, x, Wide::load(series.theta[n][a] + lane));
      theta.store(sums.theta[a] + lane);
    }
  }
  for (int a = 0; a < 6; ++a) {
    One sum(series.square[order][a]);
    for (int n = order - 1; n >= 0; --n) sum = madd(sum, One(t), One(series.square[n][a]));
    sums.square[a] = sum.v;
  }
}

}  // namespace polhode::POLHODE_ISA
