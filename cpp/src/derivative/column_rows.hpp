#pragma once

#include <cstddef>

#include "polhode/ode/series.hpp"

// The numbers that the kernels of the variational equations share with their callers.
namespace polhode {

/// A series of vectors: row k has the coefficients of s^k, of which three are used. Two rows are computed at once.
using VectorRows = double[ode::most_series_order + 2][4];

/// Rows of the matrices of x' = A x, where x are the six components of a column. They are linear in the state:
/// w' of a column = (terms of `rates`) + `pull` times its small rotation, and the small rotation changes by -w x it.
struct MatrixRow {
  double rates[6];   ///< p1 w3, p1 w2, p2 w1, p2 w3, p3 w2, p3 w1, where w1' = p1 (w2 d3 + w3 d2) + ... of a column d
  double theta[6];   ///< w3, -w2, w1, -w3, w2, -w1
  double pull[9];    ///< the derivative of torque / inertia by the small rotation, row by row
};

/// A source of one component of eight columns: `parts` times the series at `first`, of four numbers a row.
struct ColumnForce {
  alignas(64) double parts[8];
  const double* first;
  int component;
};

/// The series of one number of eight columns.
struct alignas(64) ColumnSeriesRows {
  double of[ode::most_series_order + 1][ode::series_width] = {};
};

/// The series of eight columns, number after number: d omega (3), the small rotation in body axes (3), further states.
using ColumnRows = ColumnSeriesRows*;

/// A term of x' = A(t) x + f(t): a series, or a constant, times number `from` of x. Of a force there is no `from`.
struct LinearTerm {
  int from = 0;
  std::ptrdiff_t series = -1;   ///< where it stands in a row; -1: a constant
  double factor = 0.0;          ///< the constant
};

/// What forces eight columns: parts of a series, or of 1.
struct LinearForce {
  alignas(64) double parts[8] = {};
  std::ptrdiff_t series = -1;
};

/// The equations of eight columns. Terms of number i are terms[first_term[i]] up to terms[first_term[i + 1]], and
/// forces alike.
struct LinearEquations {
  int size;
  const LinearTerm* terms;
  const int* first_term;
  const LinearForce* forces;
  const int* first_force;
  const double* series;      ///< rows of the coefficients of all series
  std::ptrdiff_t stride;     ///< numbers of a row
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
                         int force_count, int order, double unit, ColumnRows columns);
  /// The same for equations of any kind.
  void (*expand_linear)(const LinearEquations& equations, int order, double unit, ColumnRows columns);
};

/// Null if the compiler could not build the instruction set.
const ColumnKernels* baseline_column_kernels();
const ColumnKernels* avx2_column_kernels();
const ColumnKernels* avx512_column_kernels();

}  // namespace polhode
