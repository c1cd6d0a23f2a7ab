#pragma once

#include "polhode/ode/series.hpp"

// The numbers that the kernels of the variational equations share with their callers.
namespace polhode {

/// A series of vectors: row k has the coefficients of s^k, of which three are used. Two rows are computed at once.
using VectorRows = double[ode::most_series_order + 2][4];

/// Rows of the matrices of x' = A x, where x are the six components of a column. They are linear in the state:
/// w' of a column = (terms of `rates`) + `pull` times its small rotation, and the small rotation changes by -w x it.
struct MatrixRow {
  double rates[6];   ///< p1 w3, p1 w2, p2 w1, p2 w3, p3 w2, p3 w1, where w1' = p1 (w2 d3 + w3 d2) + ... of a column d
  double turn[6];    ///< w3, -w2, w1, -w3, w2, -w1
  double pull[9];    ///< the derivative of torque / inertia by the small rotation, row by row
};

/// A source of one component of eight columns: `parts` times the series at `first`, of four numbers a row.
struct ColumnForce {
  alignas(64) double parts[8];
  const double* first;
  int component;
};

/// Eight columns in lanes: d omega (3) and the small rotation in body axes (3), each with its series.
struct ColumnRows {
  alignas(64) double of[6][ode::most_series_order + 1][ode::series_width];
};

struct ColumnKernels {
  /// The series of `count` vectors from their rows 0, v' = v x w. Of `orbit` != 0 the last two rotate in space at this
  /// rate: u' = u x w + orbit t, t' = t x w - orbit u. Times are in units of `unit`.
  void (*expand_vectors)(const VectorRows& w, int order, double unit, double orbit, int count, VectorRows* vectors);
  /// out = sum_j a_j b_{n-j}, component by component.
  void (*multiply)(const VectorRows& a, const VectorRows& b, int order, VectorRows& out);
  /// Rows 1..order of eight columns from their rows 0.
  /// @param linear  constant part of the derivative of w' by omega, row by row
  /// @param pulled  the torque depends on the attitude
  void (*expand_columns)(const MatrixRow* matrix, const double* linear, bool pulled, const ColumnForce* forces,
                         int force_count, int order, double unit, ColumnRows& columns);
};

/// Null if the compiler could not build the instruction set.
const ColumnKernels* baseline_column_kernels();
const ColumnKernels* avx2_column_kernels();
const ColumnKernels* avx512_column_kernels();

}  // namespace polhode
