#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "polhode/batch/free_motion.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/quat.hpp"
#include "polhode/exact/free_motion.hpp"

using namespace polhode;

namespace {

/// 100 bodies: boxes and spins without a random generator, two of them next to and exactly on the separatrix.
struct Many {
  std::vector<double> moments, omega, attitude, t;
  Many() {
    for (int i = 0; i < 100; ++i) {
      const double a = 0.1 + 0.009 * i, b = 0.9 - 0.007 * i, c = 0.3 + 0.3 * std::sin(i);
      for (const double v : {b + c, a + c, a + b}) moments.push_back(v);
      for (const double v : {std::cos(i), std::sin(3 * i), std::cos(2 * i + 1)}) omega.push_back(v);
      for (const double v : {0.5, -0.5, 0.5, 0.5}) attitude.push_back(v);
      t.push_back(17.0 * i - 500.0);
    }
    const double near[] = {0.2, 0.4, 0.52}, spin[] = {1e-6, 5, 1e-6}, exact[] = {2, 5, 6}, balanced[] = {1, 0.75, -1};
    for (std::size_t k = 0; k < 3; ++k) {
      moments[3 * 7 + k] = near[k], omega[3 * 7 + k] = spin[k];
      moments[3 * 8 + k] = exact[k], omega[3 * 8 + k] = balanced[k];
    }
  }
  FreeMotion motion(std::size_t i) const {
    const double *I = &moments[3 * i], *w = &omega[3 * i], *q = &attitude[4 * i];
    return {Vector3d(I[0], I[1], I[2]), Vector3d(w[0], w[1], w[2]), Quat{q[0], q[1], q[2], q[3]}};
  }
  FreeMotionBatch batch() const { return {100, 1, moments.data(), omega.data(), attitude.data(), t.data(), true}; }
};

}  // namespace

TEST_CASE("a batch is the objects, one by one and on the full grid, with one thread and with three") {
  const Many many;
  FreeMotionBatch batch = many.batch();
  std::vector<double> omega(300), attitude(400);
  REQUIRE(free_motion(batch, omega.data(), attitude.data()) == 0);
  const double times[] = {0.0, 1.5, -3e3};
  batch.t = times, batch.times = 3, batch.own_times = false;
  std::vector<double> grid_omega(900), grid_attitude(1200), again(1200);
  REQUIRE(free_motion(batch, grid_omega.data(), grid_attitude.data(), 1) == 0);
  REQUIRE(free_motion(batch, nullptr, again.data(), 3) == 0);
  CHECK(again == grid_attitude);
  for (std::size_t i = 0; i < 100; ++i) {
    const State state = many.motion(i).at(many.t[i]), last = many.motion(i).at(times[2]);
    for (Eigen::Index k = 0; k < 3; ++k) {
      const auto u = static_cast<std::size_t>(k);
      CHECK(std::abs(omega[3 * i + u] - state.omega[k]) <= 2e-15 * state.omega.norm());
      CHECK(std::abs(grid_omega[9 * i + 6 + u] - last.omega[k]) <= 2e-15 * last.omega.norm());
    }
    const double *q = &attitude[4 * i], *p = &grid_attitude[12 * i + 8];
    const Quat a = conjugate(state.attitude) * Quat{q[0], q[1], q[2], q[3]},
               b = conjugate(last.attitude) * Quat{p[0], p[1], p[2], p[3]};
    CHECK(std::hypot(a.x, a.y, a.z) <= 1e-15);
    CHECK(std::hypot(b.x, b.y, b.z) <= 1e-15);
  }
}

TEST_CASE("a batch counts rows that are not finite, and refuses impossible bodies") {
  Many many;
  std::vector<double> omega(300), attitude(400);
  many.omega[30] = NAN, many.t[99] = INFINITY;
  CHECK(free_motion(many.batch(), omega.data(), attitude.data()) == 2);
  CHECK(std::isnan(omega[30]));
  CHECK(std::isnan(attitude[399]));
  CHECK(std::isfinite(omega[33]));
  many.moments[3] = 100.0;
  CHECK_THROWS_WITH_AS(free_motion(many.batch(), omega.data(), attitude.data(), 2),
                       doctest::Contains("inertia[1]"), InvalidInput);
}

TEST_CASE("directions are vectors turned by the attitudes, and floats are the doubles within 1e-6") {
  const Many many;
  FreeMotionBatch batch = many.batch();
  std::vector<double> times(33), omega(9900), attitude(13200), direction(9900), axes(300);
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = 3e5 * std::sin(static_cast<double>(i));
  for (std::size_t i = 0; i < axes.size(); ++i) axes[i] = std::cos(static_cast<double>(i));
  batch.t = times.data(), batch.times = times.size(), batch.own_times = false;
  std::vector<float> omega_single(9900), attitude_single(13200), direction_single(9900);
  REQUIRE(free_motion(batch, omega.data(), attitude.data(), 1) == 0);
  REQUIRE(free_motion(batch, {.single = {omega_single.data(), attitude_single.data(), nullptr}}, 2) == 0);
  for (const bool from_space : {false, true}) {
    const MotionOutput out{.rows = {nullptr, nullptr, direction.data()},
                           .single = {nullptr, nullptr, direction_single.data()},
                           .vector = axes.data(),
                           .from_space = from_space};
    REQUIRE(free_motion(batch, out, 1) == 0);
    for (std::size_t row = 0; row < 3300; ++row) {
      const double *q = &attitude[4 * row], *a = &axes[3 * (row / 33)];
      const Quat turn{q[0], q[1], q[2], q[3]};
      const Vector3d expected = rotate(from_space ? conjugate(turn) : turn, Vector3d(a[0], a[1], a[2]));
      for (Eigen::Index k = 0; k < 3; ++k) {
        const double found = direction[3 * row + static_cast<std::size_t>(k)];
        CHECK(std::abs(found - expected[k]) <= 3e-15);
        CHECK(direction_single[3 * row + static_cast<std::size_t>(k)] == static_cast<float>(found));
      }
    }
  }
  for (std::size_t row = 0; row < 3300; ++row) {
    const double* w = &omega[3 * row];
    const double largest = std::hypot(w[0], w[1], w[2]), *q = &attitude[4 * row];
    const float *w1 = &omega_single[3 * row], *q1 = &attitude_single[4 * row];
    for (std::size_t k = 0; k < 3; ++k) CHECK(std::abs(static_cast<double>(w1[k]) - w[k]) <= 1e-6 * largest);
    double inner = 0.0;
    for (std::size_t k = 0; k < 4; ++k) inner += static_cast<double>(q1[k]) * q[k];
    for (std::size_t k = 0; k < 4; ++k)
      CHECK(std::abs(static_cast<double>(q1[k]) * (inner < 0.0 ? -1.0 : 1.0) - q[k]) <= 5e-7);
  }
}
