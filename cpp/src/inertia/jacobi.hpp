#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "polhode/core/quat.hpp"

namespace polhode::inertia {

/// Jacobi's rotations for N symmetric 3x3 matrices side by side (Jacobi 1846; Golub & Van Loan, Matrix Computations,
/// 8.5): the plain loops over lanes become vector instructions. A lane that has converged turns by zero, exactly, so
/// the result of a lane does not depend on its neighbours, nor on N.
template <std::size_t N>
class Jacobi {
 public:
  Jacobi() {
    std::fill_n(&a_[0][0], 6 * N, 0.0);
    std::fill_n(&v_[0][0], 9 * N, 0.0);
    for (std::size_t i = 0; i < N; ++i) v_[0][i] = v_[4][i] = v_[8][i] = 1.0;
    std::fill_n(exponent_, N, 0);
  }

  /// Sets one lane, scaled by a power of two so that the largest entry lies in [0.5, 1).
  void load(std::size_t lane, double xx, double yy, double zz, double xy, double xz, double yz) {
    const double m[6] = {xx, yy, zz, xy, xz, yz};
    double largest = 0;
    for (const double x : m) largest = std::max(largest, std::abs(x));
    if (largest > 0) std::frexp(largest, &exponent_[lane]);
    for (int i = 0; i < 6; ++i) a_[i][lane] = std::ldexp(m[i], -exponent_[lane]);
  }

  void run() {
    // Convergence is quadratic: 5 sweeps do for nearly all, the rest is for the pathological.
    for (int sweep = 0; sweep < 20 && !converged(); ++sweep) {
      rotate<0, 1, 3, 4, 5>();
      rotate<0, 2, 4, 3, 5>();
      rotate<1, 2, 5, 3, 4>();
    }
  }

  Vector3d moments(std::size_t lane) const {
    return {std::ldexp(a_[0][lane], exponent_[lane]), std::ldexp(a_[1][lane], exponent_[lane]),
            std::ldexp(a_[2][lane], exponent_[lane])};
  }

  /// Columns are the eigenvectors, in the order of moments().
  Matrix3d frame(std::size_t lane) const {
    Matrix3d V;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) V(i, j) = v_[3 * i + j][lane];
    return V;
  }

 private:
  /// An entry counts as zero when turning it away would change neither diagonal entry by a rounding, nor, for positive
  /// matrices, their relative accuracy (Demmel & Veselic 1992), or when it is nothing beside the largest entry.
  static bool negligible(double app, double aqq, double apq) {
    return apq * apq <= std::abs(app * aqq) * 0x1p-110 || std::abs(apq) < 0x1p-100;
  }

  bool converged() const {
    bool all = true;
    for (std::size_t i = 0; i < N; ++i) {
      all &= negligible(a_[0][i], a_[1][i], a_[3][i]) & negligible(a_[0][i], a_[2][i], a_[4][i]) &
             negligible(a_[1][i], a_[2][i], a_[5][i]);
    }
    return all;
  }

  /// Zeroes a_PQ, stored at PQ; R is the third index, and a_RP, a_RQ are stored at RP, RQ.
  template <int P, int Q, int PQ, int RP, int RQ>
  void rotate() {
    for (std::size_t i = 0; i < N; ++i) {
      const double app = a_[P][i], aqq = a_[Q][i], arp = a_[RP][i], arq = a_[RQ][i];
      const double apq = negligible(app, aqq, a_[PQ][i]) ? 0.0 : a_[PQ][i];
      const double d = 0.5 * (aqq - app);
      const double r = std::abs(d) + std::sqrt(d * d + apq * apq);
      const double t = apq == 0.0 ? 0.0 : std::copysign(1.0, d) * apq / r;  // tan of the smaller angle
      const double c = 1 / std::sqrt(1 + t * t), s = t * c;
      a_[P][i] = app - t * apq;
      a_[Q][i] = aqq + t * apq;
      a_[PQ][i] = 0;
      a_[RP][i] = c * arp - s * arq;
      a_[RQ][i] = s * arp + c * arq;
      for (int row = 0; row < 9; row += 3) {
        const double vp = v_[row + P][i], vq = v_[row + Q][i];
        v_[row + P][i] = c * vp - s * vq;
        v_[row + Q][i] = s * vp + c * vq;
      }
    }
  }

  double a_[6][N];  ///< xx, yy, zz, xy, xz, yz
  double v_[9][N];  ///< row by row
  int exponent_[N];
};

}  // namespace polhode::inertia
