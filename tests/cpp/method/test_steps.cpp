#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "polhode/solve/solve.hpp"

// Single methods of bodies, where a symmetry or a law says what their steps must give.

using namespace polhode;

namespace {

const Quat tilted{std::sin(0.25), 0, 0, std::cos(0.25)};

}  // namespace

TEST_CASE("taylor, rates alone: a heavy body that is faster by 2^40 or 2^-40 moves the same, to the bit") {
  const auto run = [](double factor) {
    SceneParts parts{.inertia_B = InertiaTensor::from_moments({1.0, 2.0, 2.5}),
                     .omega = Vector3d(0.3, 0.2, 3.0) * factor,
                     .attitude = tilted,
                     .torques = {torques::Gravity(2.0 * factor * factor, {0.3, 0.2, 0.5})},
                     .times = {3.0 / factor, 9.0 / factor},
                     .want = {.attitude = false}};
    return solve(Scene(std::move(parts)), {.method = "taylor", .rtol = 1e-9}).omega;
  };
  const std::vector<double> base = run(1.0);
  for (const double factor : {0x1p40, 0x1p-40}) {
    const std::vector<double> fast = run(factor);
    for (std::size_t k = 0; k < 6; ++k) CHECK(fast[k] == base[k] * factor);
  }
}

TEST_CASE("radau: a body turned by half a turn about its third axis takes the same steps") {
  // That exchanges u and v, its variables near the separatrix.
  const auto run = [](double sign) {
    SceneParts parts{.inertia_B = InertiaTensor::from_moments({1.0, 2.0, 2.5}),
                     .omega = {sign * 1e-3, sign * 2.0, 1e-4},
                     .torques = {torques::AngularDamping(0.02)},
                     .times = {5.0, 20.0, 40.0}};
    return solve(Scene(std::move(parts)), {.method = "radau", .rtol = 1e-6});
  };
  const Motion one = run(1.0), other = run(-1.0);
  CHECK(one.stats.steps == other.stats.steps);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(std::abs(one.omega[3 * i] + other.omega[3 * i]) < 1e-12);
    CHECK(std::abs(one.omega[3 * i + 1] + other.omega[3 * i + 1]) < 1e-12);
    CHECK(std::abs(one.omega[3 * i + 2] - other.omega[3 * i + 2]) < 1e-12);
  }
}

TEST_CASE("jolt: |L| is kept, however light and slow the body") {
  for (const double size : {1.0, 1e-3, 1e-9, 1e-100}) {
    CAPTURE(size);
    const Vector3d moments = Vector3d(0.2, 0.4, 0.52) * size, omega{1, 2, 3};
    SceneParts parts{.inertia_B = InertiaTensor::from_moments(moments), .omega = omega, .times = {2.0}};
    const Motion motion = solve(Scene(std::move(parts)), {.method = "jolt", .step = 0.01});
    const Vector3d L(moments[0] * motion.omega[0], moments[1] * motion.omega[1], moments[2] * motion.omega[2]);
    CHECK(L.norm() / moments.cwiseProduct(omega).norm() == doctest::Approx(1.0).epsilon(1e-13));
  }
}

TEST_CASE("dmv: energy and |L| of a free body are kept over a span that is a small part of a step, too") {
  const Vector3d moments{0.2, 0.4, 0.52}, omega{1, 2, 3};
  for (const char* name : {"dmv2", "dmv4", "dmv6"}) {
    for (const double span : {1e-6, 1e-3, 0.01, 0.02, 0.055}) {
      CAPTURE(name);
      CAPTURE(span);
      SceneParts parts{.inertia_B = InertiaTensor::from_moments(moments), .omega = omega, .times = {span}};
      const Motion motion = solve(Scene(std::move(parts)), {.method = name, .step = 1.0});
      const Vector3d w(motion.omega[0], motion.omega[1], motion.omega[2]), L = moments.cwiseProduct(w);
      CHECK(L.norm() == doctest::Approx(moments.cwiseProduct(omega).norm()).epsilon(1e-13));
      CHECK(L.dot(w) == doctest::Approx(moments.cwiseProduct(omega).dot(omega)).epsilon(1e-13));
    }
  }
}
