#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "polhode/core/quat.hpp"

namespace polhode::inertia {

/// Jacobi's rotations for N symmetric 3x3 matrices side by side (Jacobi1846; GolubVanLoan, 8.5). The plain loops over
/// lanes have no branches and become vector instructions. A lane that has converged is rotated by exactly zero, so its
/// result depends neither on its neighbours nor on N.
template <std::size_t N>
class Jacobi {
 public:
  Jacobi() {
    std::fill_n(&a_[0][0], 6 * N, 0.0);
    std::fill_n(&v_[0][0], 9 * N, 0.0);
    for (std::size_t i = 0; i < N; ++i) v_[0][i] = v_[4][i] = v_[8][i] = scale_[i].once = scale_[i].again = 1.0;
  }

  /// Sets one lane, scaled by a power of two so that the largest entry lies in [0.5, 1).
  void load(std::size_t lane, double xx, double yy, double zz, double xy, double xz, double yz) {
    const double m[6] = {xx, yy, zz, xy, xz, yz};
    double largest = 0;
    for (const double x : m) largest = std::max(largest, std::abs(x));
    int exponent = 0;
    if (largest > 0) std::frexp(largest, &exponent);
    scale_[lane] = power_of_two(exponent);
    const Scale down = power_of_two(-exponent);
    for (int i = 0; i < 6; ++i) a_[i][lane] = m[i] * down.once * down.again;
  }

  void run() {
    // Convergence is quadratic and takes 4 or 5 sweeps. The bound is for matrices that are not finite.
    for (int sweep = 0; sweep < 20 && !converged(); ++sweep) {
      rotate<0, 1, 3, 4, 5>();
      rotate<0, 2, 4, 3, 5>();
      rotate<1, 2, 5, 3, 4>();
    }
  }

  Vector3d moments(std::size_t lane) const {
    const Scale up = scale_[lane];
    return {a_[0][lane] * up.once * up.again, a_[1][lane] * up.once * up.again, a_[2][lane] * up.once * up.again};
  }

  /// Columns are the eigenvectors, in the order of moments().
  Matrix3d frame(std::size_t lane) const {
    Matrix3d V;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) V(i, j) = v_[3 * i + j][lane];
    return V;
  }

 private:
  /// 2^n in two factors, each a normal number for any exponent a double can have.
  struct Scale {
    double once, again;
  };
  static Scale power_of_two(int n) {
    const auto factor = [](int e) { return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + e) << 52); };
    return {factor(n / 2), factor(n - n / 2)};
  }

  /// The square below which an off-diagonal entry counts as zero. Rotating it away would change no diagonal entry
  /// beyond rounding, relative to itself for positive matrices (DemmelVeselic1992). So does an entry below 2^-100.
  static double negligible(double app, double aqq) { return std::max(std::abs(app * aqq) * 0x1p-110, 0x1p-200); }

  bool converged() const {
    std::uint64_t left = 0;
    for (std::size_t i = 0; i < N; ++i) {
      left |= a_[3][i] * a_[3][i] > negligible(a_[0][i], a_[1][i]) ? 1u : 0u;
      left |= a_[4][i] * a_[4][i] > negligible(a_[0][i], a_[2][i]) ? 1u : 0u;
      left |= a_[5][i] * a_[5][i] > negligible(a_[1][i], a_[2][i]) ? 1u : 0u;
    }
    return left == 0;
  }

  /// Zeroes a_PQ, stored at PQ; R is the third index, and a_RP, a_RQ are stored at RP, RQ.
  template <int P, int Q, int PQ, int RP, int RQ>
  void rotate() {
    for (std::size_t i = 0; i < N; ++i) {
      const double app = a_[P][i], aqq = a_[Q][i], arp = a_[RP][i], arq = a_[RQ][i], off = a_[PQ][i];
      const double apq = off * off > negligible(app, aqq) ? off : 0.0;
      const double d = 0.5 * (aqq - app);
      const double r = std::abs(d) + std::sqrt(d * d + apq * apq) + 0x1p-300;  // for 0/0
      const double t = std::copysign(1.0, d) * apq / r;                        // tan of the smaller angle
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
  Scale scale_[N];
};

}  // namespace polhode::inertia
