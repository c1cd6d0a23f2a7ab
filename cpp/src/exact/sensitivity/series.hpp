#pragma once

#include "polhode/math/detail/number.hpp"

// The power series in t of a free motion's derivatives, in its principal axes: for short times and near spheres, where
// the parts of the closed form cancel. Each column obeys its own linear equations:
//   J d omega' = -d omega x J omega - omega x J d omega - omega x dJ omega - dJ omega',
//   d theta_B' = d omega - omega x d theta_B.
namespace polhode::exact {

inline constexpr int series_order = 30, series_slots = 16;  ///< slots: 3 rates, 3 moments, 2 free, 3 axes, 5 free

/// A free body in principal axes, scaled by powers of two.
struct SeriesStart {
  double I[3], w[3];
};

struct ColumnSeries {
  int slots = 8;  ///< 8, or 16 with the columns of the axes
  alignas(64) double omega[series_order + 1][3][series_slots];  ///< d omega of each column
  alignas(64) double theta[series_order + 1][3][series_slots];   ///< d theta in body axes
  /// The integrals of omega_i(0)^2 - omega_i^2, then of the products of the two other components alike.
  double square[series_order + 1][6];
};

struct SeriesSums {
  alignas(64) double omega[3][series_slots], theta[3][series_slots];
  double square[6];
};

}  // namespace polhode::exact
