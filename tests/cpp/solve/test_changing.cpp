#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "polhode/core/error.hpp"
#include "polhode/reference/reference.hpp"
#include "polhode/solve/invariants.hpp"
#include "polhode/solve/solve.hpp"

using namespace polhode;

namespace {

const std::vector<double> before{2.0, 0.1, -0.2, 0.1, 2.5, 0.05, -0.2, 0.05, 1.7};
const std::vector<double> after{3.1, -0.1, 0.3, -0.1, 2.9, 0.2, 0.3, 0.2, 3.4};

SceneParts make(Changing changing) {
  SceneParts parts{.inertia_B = changing.physical() ? InertiaTensor::from_moments({1, 1, 1})
                                                    : InertiaTensor::from_moments({1, 1, 1}, false)};
  parts.changing = std::move(changing);
  parts.omega = {0.9, -0.7, 1.3};
  parts.times = {0.5, 1.0, 2.0, 3.0, 4.0};
  return parts;
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

}  // namespace

TEST_CASE("a body that changes has the motion of the reference within its bound") {
  SceneParts kick = make(Changing({{1.0, 3.0, {after}}}, before, before));
  SceneParts parts_move = make(Changing::ramp(before, after, 1.0, 3.0, 3));
  parts_move.momentum = Changing({{0.0, 2.0, {{0.1, 0.0, 0.3}, {0.0, 0.2, -0.1}}}}, {}, std::vector<double>{0, 0, 0.2});
  SceneParts leaving = make(Changing::ramp(after, before, 1.0, 3.0, 1));
  leaving.leaving = true;
  SceneParts driven = make(Changing::ramp(before, after, 1.0, 3.0));
  driven.torques = {torques::GravityGradient(0.8, 0.1), torques::AngularDamping(0.05),
                    torques::Gravity(0.3, {0.1, 0.2, 0.3})};
  for (const SceneParts& parts : {make(Changing::ramp(before, after, 1.0, 3.0)), kick, parts_move, leaving, driven}) {
    const Scene scene(parts);
    const Reference truth = compute_reference(scene);
    for (const double accuracy : {1e-6, 1e-9, 1e-12}) {
      const Motion motion = solve(scene, {.accuracy = accuracy});
      CHECK(succeeded(scene, motion));
      CHECK(distance(motion.omega, truth.omega) <= std::max(motion.error, 2e-15) * motion.omega_scale());
      CHECK(distance(motion.attitude, truth.attitude) <= std::max(motion.error, 2e-15));
      const auto drift = compute_drift(scene, motion);
      CHECK(drift.contains("angular_momentum") == scene.is_closed());
      if (scene.is_closed()) CHECK(drift.at("angular_momentum") < 1e-13);
    }
  }
}

TEST_CASE("pieces are found on the side that is asked for") {
  const Changing kick({{1.0, 3.0, {after}}}, before, before);
  CHECK(kick.tensor(1.0)(0, 0) == 3.1);
  CHECK(kick.find(1.0, true).terms[0][0] == 2.0);
  CHECK(kick.tensor(std::nextafter(1.0, 0.0))(0, 0) == 2.0);
  CHECK(kick.begin() == -std::numeric_limits<double>::infinity());
}

TEST_CASE("a tensor is checked between its ends") {
  // 2 - 2 t + c t^2 touches 0 at t = 1 / c for c = 0.5, and stays above it for more.
  const auto scene = [](double c) {
    return Scene(make(Changing({{0.0, 4.0, {{2, 2, 2}, {-2, 0, 0}, {c, 0, 0}}}}, false)));
  };
  CHECK_NOTHROW(scene(0.5 + 1e-9));
  CHECK_THROWS_AS(scene(0.5 - 1e-9), InvalidInput);
  CHECK_THROWS_AS(Scene(make(Changing::ramp({1, 2, 2.5}, {1, 2, 3.1}, 0.0, 1.0))), InvalidInput);
}
