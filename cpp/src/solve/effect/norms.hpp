#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "polhode/core/quat.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode::effect {

/// An upper bound on the largest singular value of a matrix, within a few thousandths of it.
///
/// The characteristic cubic of A^T A has three real roots of the mean m, none above m + 2 sqrt(p) (Laguerre 1880, of three
/// real roots). Newton's steps from there fall towards the largest root and never pass it, so that each is a bound.
inline double bound_norm(const Matrix3d& A) {
  const Matrix3d M = A.transpose() * A;
  const double trace = M.trace();
  if (!(trace > 0.0)) return trace == 0.0 ? 0.0 : HUGE_VAL;
  const double minors = M(0, 0) * M(1, 1) - M(0, 1) * M(0, 1) + M(1, 1) * M(2, 2) - M(1, 2) * M(1, 2) +
                        M(2, 2) * M(0, 0) - M(2, 0) * M(2, 0);
  const double determinant = M.determinant();
  constexpr double close = 4e-3, rounding = 1e-12;
  const double mean = trace / 3.0, p = std::max(0.0, mean * mean - minors / 3.0);
  double root = mean + 2.0 * std::sqrt(p);
  for (int i = 0; i < 8; ++i) {
    const double value = ((root - trace) * root + minors) * root - determinant;
    const double slope = (3.0 * root - 2.0 * trace) * root + minors;
    if (!(value > 0.0 && slope > 0.0)) break;
    const double step = value / slope;
    root -= step;
    if (step < close * root) break;
  }
  return std::sqrt(root + rounding * trace);
}

/// (e^x - 1) / x, the mean of e^y over 0 <= y <= x.
inline double mean_growth(double x) { return x < 1e-4 ? 1.0 + x : math::expm1(x) / x; }

}  // namespace polhode::effect
