#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "polhode/core/error.hpp"
#include "polhode/exact/free_motion.hpp"
#include "polhode/ode/drive.hpp"
#include "polhode/ode/methods.hpp"
#include "polhode/method/euler_problem.hpp"
#include "polhode/method/methods.hpp"
#include "polhode/solve/invariants.hpp"
#include "polhode/solve/plan.hpp"
#include "polhode/solve/solve.hpp"

using namespace polhode;

namespace {

Scene make_block(std::vector<double> times, std::vector<AnyTorque> torques = {}) {
  return Scene({.inertia_B = InertiaTensor::from_moments({0.20, 0.40, 0.52}),
                .omega = {1, 2, 3},
                .torques = std::move(torques),
                .times = std::move(times)});
}

}  // namespace

TEST_CASE("solve agrees with the closed form, forwards and backwards") {
  const Scene scene = make_block({10.0, -3.0, 0.0});
  const Motion motion = solve(scene, {.rtol = 1e-12});
  const FreeMotion free(Vector3d{0.20, 0.40, 0.52}, Vector3d{1, 2, 3});
  REQUIRE(motion.t.size() == 3);
  for (std::size_t i = 0; i < 3; ++i) {
    const State exact = free.at(motion.t[i]);
    for (std::size_t k = 0; k < 3; ++k)
      CHECK(std::abs(motion.omega[3 * i + k] - exact.omega[static_cast<int>(k)]) < 1e-9);
  }
  CHECK(succeeded(scene, solve(scene, {.accuracy = 1e-8})));
  CHECK(compute_drift(scene, motion).size() == 2);
}

TEST_CASE("a C++ callable is a torque, and its exception comes through") {
  const auto thruster =
      torques::Custom::from([](double, const double*, const double*,
                               double* torque) { torque[0] = 0.01, torque[1] = -0.02, torque[2] = 0.03; },
                            {.uses_time = false, .uses_attitude = false, .uses_rates = false});
  const Motion mine = solve(make_block({5.0}, {thruster}), {.rtol = 1e-9});
  const Motion built_in = solve(make_block({5.0}, {torques::Constant({0.01, -0.02, 0.03})}), {.rtol = 1e-9});
  CHECK(mine.omega == built_in.omega);

  const auto broken = torques::Custom::from(
      [](double t, const double*, const double*, double*) {
        if (t > 1) throw std::domain_error("out of fuel");
      },
      {});
  CHECK_THROWS_AS(solve(make_block({5.0}, {broken})), InvalidInput);   // it wrote nothing: NaN is named
}

TEST_CASE("options that contradict each other are refused") {
  const Scene scene = make_block({1.0});
  CHECK_THROWS_AS(solve(scene, {.accuracy = 1e-6, .rtol = 1e-6}), InvalidInput);
  CHECK_THROWS_AS(solve(scene, {.accuracy = 0.0}), InvalidInput);
  CHECK_THROWS_AS(solve(scene, {.method = "rk54"}), InvalidInput);
  CHECK_THROWS_AS(solve(scene, {.step = 0.1}), InvalidInput);
  CHECK_THROWS_AS(make_block({}), InvalidInput);
}

TEST_CASE("events end a run, and progress is told") {
  SolveOptions options{.rtol = 1e-10, .events = {{[](const State& s) { return s.omega[0]; }, 0, true}}};
  const Motion motion = solve(make_block({0.0, 100.0}), options);
  CHECK(motion.status == Status::event);
  REQUIRE(motion.events.size() == 1);
  CHECK(std::abs(motion.events[0].state.omega[0]) < 1e-9);
  CHECK(motion.t.size() == 1);
}

namespace {

/// A torque of a user's own in C++: inlined into whatever steps it.
struct Thruster {
  void add(const TorqueInput&, double* tau_B) const { tau_B[0] += 0.01, tau_B[1] += -0.02, tau_B[2] += 0.03; }
};

}  // namespace

TEST_CASE("rates whose square is beyond float64 are no success of any method") {
  SceneParts parts{.inertia_B = InertiaTensor::from_moments({1.6, 1.6, 1.7})};
  parts.omega = {1e-3, 1e-3, 1e160};
  parts.times = {1e-3, 1.0};
  const Scene scene(parts);
  for (const ode::MethodRecord& record : methods()) {
    CAPTURE(record.name);
    if (!compute_refusal(record.name, scene).empty()) continue;
    SolveOptions options{.method = std::string(record.name), .max_steps = 100};
    if (record.adaptive) {
      options.rtol = 1e-6;
    } else {
      options.step = 1e-2;
    }
    CHECK_FALSE(succeeded(scene, solve(scene, options)));
  }
}

TEST_CASE("a functor is stepped by any general method, with no call between") {
  const Scene scene = make_block({5.0}, {torques::Constant({0.01, -0.02, 0.03})});
  const Thruster thruster;
  const EulerProblem<Thruster, true, true> problem(scene.inertia_B(), thruster);
  double y0[7], end[7];
  problem.pack(scene.start(), y0);
  ode::Dop853::Stepper<EulerProblem<Thruster, true, true>> stepper(problem, 0.0, y0, 5.0, {.rtol = 1e-10});
  const double times[] = {5.0};
  ode::drive(stepper, times,
             [&](std::size_t, std::span<const double> at, const double* rows) {
               std::copy_n(rows + 7 * (at.size() - 1), 7, end);
             },
             {});
  const Motion built_in = solve(scene, {.method = "dop853", .rtol = 1e-10});
  for (std::size_t k = 0; k < 3; ++k) CHECK(end[k] == built_in.omega[k]);
}
