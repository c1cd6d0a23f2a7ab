// What planning costs, before anything is solved: facts, candidates and choice, without the words.
#include <chrono>
#include <cstdio>
#include <vector>

#include "polhode/solve/plan.hpp"

using namespace polhode;

namespace {

double measure(const Scene& scene) {
  using Clock = std::chrono::steady_clock;
  const SolveOptions options{.accuracy = 1e-9};
  double best = 1.0;
  for (int repeat = 0; repeat < 200; ++repeat) {
    const auto begin = Clock::now();
    for (int i = 0; i < 50; ++i) {
      const Plan plan = make_plan(scene, options);
      if (plan.method.empty()) std::puts("no plan");
    }
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count() / 50;
    best = seconds < best ? seconds : best;
  }
  return best;
}

}  // namespace

int main() {
  std::vector<double> times(10);
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = static_cast<double>(i);
  const auto make = [&](const Vector3d& moments, std::vector<AnyTorque> torques) {
    return Scene({.inertia_B = InertiaTensor::from_moments(moments),
                  .omega = {1, 2, 3},
                  .torques = std::move(torques),
                  .times = times});
  };
  std::printf("free body          %6.2f us\n", 1e6 * measure(make({0.2, 0.4, 0.52}, {})));
  std::printf("symmetric body     %6.2f us\n", 1e6 * measure(make({1, 1, 0.5}, {})));
  std::printf("Lagrange's top     %6.2f us\n", 1e6 * measure(make({1, 1, 0.5}, {torques::Gravity(2, {0, 0, 1})})));
  std::printf("heavy body         %6.2f us\n",
              1e6 * measure(make({1, 2, 2.5}, {torques::Gravity(2, {0.3, 0.2, 0.5})})));
  std::printf("thruster           %6.2f us\n", 1e6 * measure(make({1, 2, 2.5}, {torques::Constant({0.1, 0, 0})})));
  std::printf("damped body        %6.2f us\n",
              1e6 * measure(make({1, 2, 2.5}, {torques::Damping(Matrix3d::Identity())})));
}
