#include <doctest/doctest.h>

#include <chrono>
#include <limits>
#include <memory>
#include <vector>

#include "polhode/core/error.hpp"
#include "polhode/solve/plan.hpp"
#include "polhode/torque/torques.hpp"

using namespace polhode;

namespace {

Scene make_plan_scene(AnyTorque torque, double end) {
  return Scene(SceneParts{.inertia_B = InertiaTensor::from_moments({1, 2, 2.5}),
                          .omega = {1, 2, 3},
                          .torques = {std::move(torque)},
                          .times = {end}});
}

}  // namespace

TEST_CASE("a pilot run ends when progress says so") {
  const auto calls = std::make_shared<int>(0);
  const auto slow = [calls](double, const double* omega, const double*, double* torque) {
    ++*calls;
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(2);
    while (std::chrono::steady_clock::now() < end) {
    }
    for (int i = 0; i < 3; ++i) torque[i] = -0.01 * omega[i];
  };
  const Scene scene = make_plan_scene(torques::Custom::from(slow, {}), 1000.0);
  SolveOptions options;
  options.accuracy = 1e-6;
  int asked = 0;
  options.progress = [&asked](double, double) { return ++asked < 2; };
  const Plan plan = make_plan(scene, options);
  CHECK(asked == 2);
  CHECK(*calls < 1000);   // of some 4000: it is asked after every few steps
  CHECK(plan.predicted_seconds > 0.0);
}

TEST_CASE("a pilot run has no more steps than max_steps") {
  const auto calls = std::make_shared<int>(0);
  const auto brake = [calls](double, const double* omega, const double*, double* torque) {
    ++*calls;
    for (int i = 0; i < 3; ++i) torque[i] = -0.01 * omega[i];
  };
  const Scene scene = make_plan_scene(torques::Custom::from(brake, {}), 1e6);
  SolveOptions options;
  options.accuracy = 1e-6;
  options.max_steps = 10;
  make_plan(scene, options);
  CHECK(*calls < 500);
}

TEST_CASE("damping of any strength is planned") {
  for (const double strength : {1e30, 1e150, 1e300}) {
    SolveOptions options;
    options.accuracy = 1e-6;
    const Plan plan = make_plan(make_plan_scene(torques::Damping(Vector3d{strength, 1, 1}.asDiagonal()), 1.0), options);
    CAPTURE(strength);
    CHECK(plan.method == "radau");
  }
}

TEST_CASE("the span is divided at the breaks of an own torque, given or found") {
  const auto pulse = [](double t, const double*, const double*, double* torque) {
    torque[0] = torque[1] = 0.0, torque[2] = 3.0 <= t && t < 3.02 ? 5.0 : 0.0;
  };
  const torques::Custom torque = torques::Custom::from(pulse, {});
  CHECK(torque.with_breaks({2.0, 1.0, 2.0}).breaks() == std::vector{1.0, 2.0});
  CHECK_THROWS_AS(torque.with_breaks({std::numeric_limits<double>::infinity()}), InvalidInput);
  SolveOptions options;
  options.accuracy = 1e-9;
  for (const torques::Custom& one : {torque, torque.with_breaks({3.0, 3.02})}) {
    const Plan plan = make_plan(make_plan_scene(one, 20.0), options);
    REQUIRE(plan.pieces.size() == 3);
    CHECK(plan.pieces[1].begin == 3.0);
    CHECK(plan.pieces[1].end == 3.02);
  }
}
