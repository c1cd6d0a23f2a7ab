#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "polhode/core/quat.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode::effect {

/// An upper bound on the largest singular value of a matrix, within a few thousandths of it.
///
/// With the mean m of the eigenvalues of A^T A and 6 p = |A^T A - m|^2, the largest of them is m + sqrt(p) x, where x is
/// the largest root of x^3 - 3 x = 2 r, 2 r = det(A^T A - m) / p^(3/2). It is at most 2. Newton's steps from 2 fall
/// towards it and never pass it, so that each is a bound. Without the shift by m, three roots that are nearly equal would
/// drown in rounding.
inline double bound_norm(const Matrix3d& A) {
  Matrix3d M = A.transpose() * A;
  const double trace = M.trace();
  if (!(trace > 0.0)) return trace == 0.0 ? 0.0 : HUGE_VAL;
  const double mean = trace / 3.0;
  for (int i = 0; i < 3; ++i) M(i, i) -= mean;
  const double p = M.squaredNorm() / 6.0, width = std::sqrt(p);
  constexpr double close = 4e-3, rounding = 1e-12, least_slope = 1e-3;
  double x = 2.0;
  if (width > rounding * mean) {
    const double twice_r = M.determinant() / (p * width);
    for (int i = 0; i < 8; ++i) {
      const double value = (x * x - 3.0) * x - twice_r, slope = 3.0 * (x * x - 1.0);
      if (!(value > 0.0 && slope > least_slope)) break;
      const double step = value / slope;
      x -= step;
      if (step < close) break;
    }
  }
  return std::sqrt(mean + width * x + rounding * trace);
}

/// (e^x - 1) / x, the mean of e^y over 0 <= y <= x.
inline double mean_growth(double x) { return x < 1e-4 ? 1.0 + x : math::expm1(x) / x; }

}  // namespace polhode::effect
