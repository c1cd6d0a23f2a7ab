#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "polhode/derivative/sensitivity.hpp"

// Columns of driven bodies, which the Taylor series integrates beside the state, against formulas.

using namespace polhode;

TEST_CASE("a sphere with damping: the columns of all nine entries of the matrix are the formula's") {
  // I w_i' = -c_i w_i without the other entries. C_ij adds -w_j: its column is w_j convolved with exp(-c_i t / I) / I.
  const Vector3d c{0.3, 0.8, 1.7}, omega{0.5, -1.1, 0.7};
  constexpr double I = 2.0, t = 1.5;
  SceneParts parts{.inertia_B = InertiaTensor::from_moments({I, I, I}), .omega = omega, .times = {t}};
  parts.torques = {torques::Damping(Matrix3d(c.asDiagonal()))};
  const MotionSensitivity found = compute_sensitivity(Scene(parts), {"torques.0.matrix"}, {.accuracy = 1e-12});
  REQUIRE(found.columns.size() == 9);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const std::size_t column = static_cast<std::size_t>(3 * i + j);
      CHECK(found.columns[column] == std::string("torques.0.matrix_") + "xyz"[i] + "xyz"[j]);
      const double decay_i = std::exp(-c[i] * t / I), decay_j = std::exp(-c[j] * t / I);
      const double expected = -omega[j] * (i == j ? t / I * decay_i : (decay_j - decay_i) / (c[i] - c[j]));
      for (std::size_t k = 0; k < 3; ++k) {
        CAPTURE(found.columns[column]);
        CHECK(std::abs(found.d_omega[9 * k + column] - (k == static_cast<std::size_t>(i) ? expected : 0.0)) < 1e-12);
      }
    }
  }
}
