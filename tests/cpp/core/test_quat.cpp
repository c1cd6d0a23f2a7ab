#include <doctest/doctest.h>

#include "polhode/core/error.hpp"
#include "polhode/core/quat.hpp"

using namespace polhode;

TEST_CASE("the attitude at the door is unit, or refused") {
  const Quat q = make_attitude({1e-7, 0, 0, 1});
  CHECK(norm(q) == doctest::Approx(1).epsilon(1e-15));
  CHECK_THROWS_AS(make_attitude({0, 0, 0, 0}), InvalidInput);
  CHECK_THROWS_AS(make_attitude({0, 0, 0, 2}), InvalidInput);
  CHECK_THROWS_AS(make_attitude({0, 0, NAN, 1}), InvalidInput);
  CHECK_THROWS_AS(make_attitude({0, 0, INFINITY, 1}), InvalidInput);
}

TEST_CASE("a quarter turn about z takes body x to space y, by quaternion and by matrix") {
  const Quat q_WB{0, 0, std::sqrt(0.5), std::sqrt(0.5)};
  const Vector3d expected{0, 1, 0};
  CHECK((rotate(q_WB, Vector3d{1, 0, 0}) - expected).norm() < 1e-15);
  CHECK((to_matrix(q_WB) * Vector3d{1, 0, 0} - expected).norm() < 1e-15);
}

TEST_CASE("the product composes: R(pq) = R(p) R(q)") {
  const Quat p = normalized({0.1, -0.7, 0.4, 0.5}), q = normalized({-0.3, 0.2, 0.9, -0.1});
  CHECK((to_matrix(p * q) - to_matrix(p) * to_matrix(q)).norm() < 1.5e-15);
  CHECK(norm(p * conjugate(p)) == doctest::Approx(1).epsilon(1e-15));
}
