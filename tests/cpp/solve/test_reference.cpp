#include <doctest/doctest.h>

#include <cmath>

#include "polhode/core/error.hpp"
#include "polhode/exact/free_motion.hpp"
#include "polhode/reference/reference.hpp"

using namespace polhode;

namespace {

Scene make(std::vector<AnyTorque> torques, std::vector<double> times) {
  SceneParts parts{InertiaTensor::from_moments({1.0, 2.0, 2.5})};
  parts.omega = {1, 2, 3};
  parts.torques = std::move(torques);
  parts.times = std::move(times);
  return Scene(std::move(parts));
}

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

}  // namespace

TEST_CASE("the reference of a free body is its closed form, before and after the start and in any order") {
  const std::vector<double> times{30.0, -20.0, 0.0, 7.5, -0.1, 30.0};
  const Reference found = compute_reference(make({}, times));
  const FreeMotion exact(InertiaTensor::from_moments({1.0, 2.0, 2.5}), {1, 2, 3});
  for (std::size_t k = 0; k < times.size(); ++k) {
    const State state = exact.at(times[k]);
    for (int i = 0; i < 3; ++i)
      CHECK(found.omega[3 * k + static_cast<std::size_t>(i)] == doctest::Approx(state.omega[i]).epsilon(4e-15));
    const double* q = &found.attitude[4 * k];
    const double along =
        q[0] * state.attitude.x + q[1] * state.attitude.y + q[2] * state.attitude.z + q[3] * state.attitude.w;
    CHECK(std::abs(along) == doctest::Approx(1.0).epsilon(1e-15));
  }
  CHECK(found.steps > 20);
}

TEST_CASE("two orders agree under every torque") {
  const Scene scene = make({torques::Gravity(2.0, {0.3, 0.2, 0.5}),
                            torques::Damping(Vector3d(0.01, 0.02, 0.03).asDiagonal().toDenseMatrix()),
                            torques::Constant({0.01, 0.02, 0.03}, torques::Constant::Frame::space),
                            torques::Constant({0.03, 0.0, -0.01}), torques::GravityGradient(0.5, 0.3)},
                           {1.0, 5.0, 10.0});
  const Reference a = compute_reference(scene, {.order = 28}), b = compute_reference(scene, {.order = 20});
  CHECK(distance(a.omega, b.omega) < 1e-15);
  CHECK(distance(a.attitude, b.attitude) < 3e-16);
  CHECK(b.steps > a.steps);
}

TEST_CASE("what has no series is refused, and a run has its bound") {
  CHECK_THROWS_AS(compute_reference(make({}, {1e6}), {.max_steps = 100}), IntegrationFailure);
  int asked = 0;
  CHECK_THROWS_AS(compute_reference(make({}, {1e6}), {.go_on = [&] { return ++asked < 3; }}), IntegrationFailure);
  CHECK(asked == 3);
}
