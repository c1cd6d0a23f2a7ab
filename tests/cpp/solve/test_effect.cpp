#include <doctest/doctest.h>

#include <Eigen/SVD>
#include <cmath>

#include "polhode/exact/free_motion.hpp"
#include "polhode/exact/free_sensitivity.hpp"
#include "polhode/math/detail/coin.hpp"
#include "solve/effect/free_table.hpp"
#include "solve/effect/norms.hpp"

using namespace polhode;

namespace {

/// Numbers between -1 and 1 from tosses.
double draw(math::Coin& coin) {
  double x = 0.0;
  for (int i = 1; i <= 30; ++i) x += coin.toss() ? std::ldexp(1.0, -i) : -std::ldexp(1.0, -i);
  return x;
}

Matrix3d draw_matrix(math::Coin& coin) {
  Matrix3d A;
  for (double& entry : A.reshaped()) entry = draw(coin);
  return A;
}

double find_norm(const Matrix3d& A) { return Eigen::JacobiSVD<Matrix3d>(A).singularValues()[0]; }

Matrix3d read(const double* rows) {
  Matrix3d A;
  for (int i = 0; i < 9; ++i) A(i / 3, i % 3) = rows[i];
  return A;
}

}  // namespace

TEST_CASE("effect: norms are bounds, and close, also of matrices near a multiple of a rotation") {
  math::Coin coin(31);
  for (int number = 0; number < 3000; ++number) {
    const double size = std::ldexp(1.0, -(number % 50));
    Matrix3d A = draw_matrix(coin);
    if (number % 3 == 0) A = Matrix3d::Identity() + size * A;
    if (number % 3 == 1) A = A.col(0) * A.row(1) + size * draw_matrix(coin);
    const double norm = find_norm(A), bound = effect::bound_norm(A);
    CHECK(bound >= norm * (1 - 1e-14));
    CHECK(bound <= norm * 1.005);
  }
}

TEST_CASE("effect: over whole periods the columns are below the sums of the table") {
  const Vector3d moments{1.0, 1.7, 2.6};
  for (const Vector3d& omega : {Vector3d(0.4, 0.7, 1.3), Vector3d(1.5, 0.6, 0.2)}) {
    const effect::FreeBody body(moments, omega);
    CHECK(body.period == doctest::Approx(FreeMotion(moments, omega).period()).epsilon(1e-12));
    const effect::FreeTable table(body, 400.0);
    REQUIRE(table.is_periodic());
    const Vector3d by_root = moments.cwiseSqrt().cwiseInverse(), root = moments.cwiseSqrt();
    for (const int phase : {0, table.cells() / 3}) {
      const FreeSensitivity columns(FreeMotion(moments, table.rates(phase)), {SensitivityTo::omega});
      for (const int later : {0, table.cells() / 2, table.cells() - 1}) {
        for (const int k : {1, 2, 9, 1000}) {
          const double t = k * body.period + later * table.width();
          double d_omega[9], d_theta[9];
          columns.at(&t, 1, nullptr, nullptr, d_omega, d_theta);
          const Matrix3d S = root.asDiagonal() * read(d_omega) * by_root.asDiagonal();
          const Matrix3d Psi = read(d_theta) * by_root.asDiagonal();
          const auto bound = [&](effect::Passage of) {
            return table.norms(of, phase)[later] + k * table.slopes(of, phase)[later];
          };
          const double tilt = 2.0 * root[2] / body.L;
          CHECK(find_norm(S) <= bound(effect::state_of_state) * (1 + 1e-9));
          CHECK(find_norm(Psi) <= (bound(effect::rotation_of_state) + tilt) * (1 + 1e-9));
          if (k < 1000) continue;
          CHECK(find_norm(S) >= 0.99 * bound(effect::state_of_state));
          CHECK(find_norm(Psi) >= 0.99 * bound(effect::rotation_of_state));
        }
      }
    }
  }
}
