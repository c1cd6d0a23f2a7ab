#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "polhode/exact/free_motion.hpp"
#include "polhode/exact/heavy_top.hpp"
#include "polhode/method/methods.hpp"
#include "polhode/solve/plan.hpp"
#include "polhode/solve/solve.hpp"

// Every method of the list on bodies with rotors. The truth is a symmetric body with a wheel on its axis: the body
// without the wheel, with omega3 + h / I3, turned back about its axis by h t / I3.

using namespace polhode;

namespace {

constexpr double h = 0.8, weight_arm = 2.0, end_time = 3.0;
const Vector3d moments{1, 1, 0.5}, start{0.3, -0.2, 3};
const Quat tilted{std::sin(0.35), 0, 0, std::cos(0.35)};

Scene make_scene(bool heavy, double scale = 1.0) {
  SceneParts parts{.inertia_B = InertiaTensor::from_moments(moments),
                   .omega = start,
                   .attitude = tilted,
                   .times = {0.5 * end_time, end_time},
                   .rotors = {Rotor({.axis = {0, 0, 1}, .momentum = 0.5 * h * scale}),
                              Rotor({.axis = {0, 0, 2}, .inertia = 0.1, .speed = 5 * h * scale})}};
  if (heavy) parts.torques = {torques::Gravity(weight_arm, {0, 0, 1})};
  return Scene(std::move(parts));
}

State truth(bool heavy, double t) {
  const InertiaTensor I = InertiaTensor::from_moments(moments);
  const Vector3d w{start[0], start[1], start[2] + h / moments[2]};
  State state = heavy ? HeavyTop(I, weight_arm, w, tilted).at(t) : FreeMotion(I, w, tilted).at(t);
  const double b = h * t / moments[2], x = state.omega[0], y = state.omega[1];
  state.omega = {std::cos(b) * x - std::sin(b) * y, std::sin(b) * x + std::cos(b) * y, state.omega[2] - h / moments[2]};
  state.attitude = state.attitude * Quat{0, 0, -std::sin(b / 2), std::cos(b / 2)};
  return state;
}

double compute_error(bool heavy, const Motion& motion) {
  double error = 0.0;
  for (std::size_t i = 0; i < motion.t.size(); ++i) {
    const State exact = truth(heavy, motion.t[i]);
    const double q[4] = {exact.attitude.x, exact.attitude.y, exact.attitude.z, exact.attitude.w};
    double near = 0.0, far = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
      near = std::max(near, std::abs(motion.attitude[4 * i + k] - q[k]));
      far = std::max(far, std::abs(motion.attitude[4 * i + k] + q[k]));
    }
    error = std::max(error, std::min(near, far));
    for (std::size_t k = 0; k < 3; ++k)
      error = std::max(error, std::abs(motion.omega[3 * i + k] - exact.omega[static_cast<int>(k)]));
  }
  return error;
}

}  // namespace

TEST_CASE("every method: a body with rotors, free and heavy, to its order, or a refusal that names them") {
  for (const ode::MethodRecord& method : methods()) {
    const std::string name(method.name);
    CAPTURE(name);
    for (const bool heavy : {false, true}) {
      CAPTURE(heavy);
      const Scene scene = make_scene(heavy);
      if (const std::string why = compute_refusal(name, scene); !why.empty()) {
        CHECK(why.find("rotors") != std::string::npos);
        CHECK(method.needs.find("no rotors") != std::string::npos);
        continue;
      }
      CHECK(method.needs.find("no rotors") == std::string::npos);
      SolveOptions options{.method = name};
      if (method.adaptive) {
        for (const double rtol : {1e-6, 1e-10}) {
          options.rtol = rtol;
          CHECK(compute_error(heavy, solve(scene, options)) < 300 * rtol);
        }
        continue;
      }
      double error[2];
      for (int k = 0; k < 2; ++k) {
        options.step = k == 0 ? 0.004 : 0.002;
        error[k] = compute_error(heavy, solve(scene, options));
      }
      if (method.order == 0) continue;   // solves other equations
      const double slope = std::log2(error[0] / error[1]), order = method.order_with_torque();
      CAPTURE(error[0]);
      CAPTURE(error[1]);
      CHECK(error[1] < 0.05);
      CHECK(slope > order - 0.3);
      CHECK(slope < order + 0.6);
    }
  }
}

TEST_CASE("rotors whose momenta cancel leave a free body, and no rotor changes a bit") {
  SceneParts parts = make_scene(false).parts();
  parts.rotors = {Rotor({.axis = {0, 0, 1}, .momentum = h}), Rotor({.axis = {0, 0, -1}, .momentum = h})};
  const Scene cancelled(parts);
  CHECK(cancelled.rotor_momentum().isZero(0.0));
  CHECK(cancelled.torque_sum().acting == 0);
  parts.rotors.clear();
  const Motion one = solve(cancelled), other = solve(Scene(parts));
  CHECK(one.plan.method == "exact");
  CHECK(one.omega == other.omega);
  CHECK(one.attitude == other.attitude);
}

TEST_CASE("a free rotor's inertia is taken from the body, and its momentum stays with the copies of a scene") {
  SceneParts parts = make_scene(false).parts();
  parts.rotors = {Rotor({.axis = {1, 0, 0}, .inertia = 0.25, .speed = 4, .free = true})};
  const Scene scene(parts);
  CHECK(scene.given_inertia_B().matrix()(0, 0) == 1.0);
  CHECK(scene.inertia_B().matrix()(0, 0) == 0.75);
  CHECK(scene.rotor_momentum()[0] == 0.25 * (4 + start[0]));
  SceneParts copy = scene.parts();
  copy.omega = {7, 7, 7};
  CHECK(Scene(copy).rotor_momentum()[0] == scene.rotor_momentum()[0]);
  CHECK(Scene(copy).inertia_B().matrix()(0, 0) == 0.75);
  double speed = 0.0;
  const double t = 1.0, w[3] = {2.0, 0, 0};
  compute_rotor_speed(scene, 1, &t, w, nullptr, &speed);
  CHECK(std::abs(speed - (4 + start[0] - 2.0)) < 1e-15);
}
