// Scenes in C++: a torque of the library, a formula, a torque of one's own, and many bodies by the free step. The page
// "C++ in ten minutes" shows the four functions.
#include <cmath>
#include <cstdio>
#include <vector>

#include <polhode/polhode.hpp>

namespace ph = polhode;

// gravity
void follow_heavy_body() {
  ph::SceneParts parts{.inertia_B = ph::InertiaTensor::from_moments({1.0, 2.0, 2.5}),   // kg m^2, about the pivot
                       .omega = {0.3, 0.2, 3.0}};                                       // rad/s, body axes
  parts.torques.emplace_back(ph::torques::Gravity(2.0, {0.3, 0.2, 0.5}));               // weight in N, arm in m
  for (int i = 1; i <= 10; ++i) parts.times.push_back(i);

  const ph::Motion motion = ph::solve(ph::Scene(parts), {.accuracy = 1e-9});
  const double* w = &motion.omega[3 * 9];   // (n, 3), row by row; attitude (n, 4)
  std::printf("heavy body by %s: omega %.8f %.8f %.8f at 10 s, error below %.0e\n", motion.plan.method.c_str(), w[0],
              w[1], w[2], motion.error);
}

// formula
void follow_formula() {
  const auto law = [](const auto& in) {   // called once, on symbols
    const auto aim = to_body(in.attitude, in.vector(0.0, 0.0, 1.0)), axis = in.vector(0.0, 0.0, 1.0);
    return cross(axis, aim) * in.p("stiffness") - in.omega * in.p("damping");   // N m, body axes
  };
  ph::SceneParts parts{.inertia_B = ph::InertiaTensor::from_moments({1.0, 2.0, 2.5}), .omega = {0.3, 0.2, 1.0}};
  parts.torques.emplace_back(ph::torques::Formula::from(law, {{"stiffness", {0.6}}, {"damping", {0.5}}}));
  parts.times = {5.0};
  const ph::Scene scene(parts);

  const ph::Motion motion = ph::solve(scene, {.accuracy = 1e-9});
  const ph::MotionSensitivity by = ph::compute_sensitivity(scene, {"torques.0.damping"});
  std::printf("formula by %s: omega_x %.8f rad/s, by the damping %.8f, error below %.0e\n", motion.plan.method.c_str(),
              motion.omega[0], by.d_omega[0], motion.error);
}

// own torque
void follow_own_torque() {
  const double brake = 0.5;   // N m s
  const auto torque = [brake](double /*t*/, const double* omega, const double* /*attitude*/, double* tau_B) {
    tau_B[0] = tau_B[1] = 0.0;
    tau_B[2] = -brake * omega[2];   // N m, body axes
  };
  ph::SceneParts parts{.inertia_B = ph::InertiaTensor::from_moments({1.0, 1.5, 2.0}), .omega = {0.0, 0.0, 3.0}};
  parts.torques.emplace_back(ph::torques::Custom::from(torque, {.uses_time = false, .uses_attitude = false}));
  parts.times = {4.0};

  const ph::Motion motion = ph::solve(ph::Scene(parts), {.accuracy = 1e-9});
  std::printf("own torque: omega_z %.8f rad/s, by hand %.8f\n", motion.omega[2], 3.0 * std::exp(-brake / 2.0 * 4.0));
}

// many bodies
void step_many_bodies() {
  const std::size_t n = 1000;
  const std::vector<float> moments = {0.2f, 0.4f, 0.5f};   // of all bodies
  std::vector<float> momentum, attitude;                   // in space; principal axes to space, (x, y, z, w)
  for (std::size_t i = 0; i < n; ++i) {
    momentum.insert(momentum.end(), {0.02f, 2.0f, 0.05f});
    attitude.insert(attitude.end(), {0.0f, 0.0f, 0.0f, 1.0f});
  }
  ph::StepBatch<float> batch;
  batch.bodies = n;
  batch.moments = moments.data(), batch.one_inertia = true;
  batch.step = 1.0f / 60, batch.count = 60;   // a second
  batch.momentum = momentum.data(), batch.attitude = attitude.data();
  ph::step_bodies(batch);

  const ph::FreeMotion exact(ph::InertiaTensor::from_moments({0.2, 0.4, 0.5}), {0.1, 5.0, 0.1});
  const ph::Quat q = exact.at(1.0).attitude;
  const float* p = &attitude[4 * (n - 1)];
  const double sign = q.x * p[0] + q.y * p[1] + q.z * p[2] + q.w * p[3] < 0.0 ? -1.0 : 1.0;
  const double x = p[0] - sign * q.x, y = p[1] - sign * q.y, z = p[2] - sign * q.z, w = p[3] - sign * q.w;
  const double angle = 2.0 * std::sqrt(x * x + y * y + z * z + w * w);
  std::printf("many bodies: %s from the closed form\n", angle < 1e-4 ? "less than 1e-4 rad" : "far");
}

// main
int main() {
  follow_heavy_body();
  follow_formula();
  follow_own_torque();
  step_many_bodies();
}
