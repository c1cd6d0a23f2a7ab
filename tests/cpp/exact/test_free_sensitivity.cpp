#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "polhode/batch/free_sensitivity.hpp"
#include "polhode/core/error.hpp"
#include "polhode/exact/free_sensitivity.hpp"

using namespace polhode;

namespace {

const Vector3d sensitive_block{0.20, 0.40, 0.52};
const Quat sensitive_start = normalized({0.5, -0.1, 0.7, 0.5});

}  // namespace

TEST_CASE("columns of the moments sum to nothing, and those of omega scale time") {
  const Vector3d starts[] = {{1, 2, 3}, {1e-4, 5, 1e-4}, {0, 5, 0}, {3, 1e-9, 0.1}, {0, 0, 2}};
  for (const Vector3d& omega : starts) {
    const FreeMotion motion(sensitive_block, omega, sensitive_start);
    const FreeSensitivity columns(motion, {SensitivityTo::omega, SensitivityTo::inertia, SensitivityTo::time});
    REQUIRE(columns.columns() == 7);
    for (const double t : {0.0, 1e-6, 0.1, 1.7, -9.0}) {
      double w[3], q[4], d_w[21], d_q[21];
      columns.at(&t, 1, w, q, d_w, d_q);
      for (int r = 0; r < 3; ++r) {
        const double *a = d_w + 7 * r, *b = d_q + 7 * r;
        double size_w = 1, size_q = 1;
        for (int c = 0; c < 6; ++c) size_w += std::abs(a[c]) * 5, size_q += std::abs(b[c]) * 5;
        const auto weighted = [](const double* row, const Vector3d& v) {
          return row[0] * v[0] + row[1] * v[1] + row[2] * v[2];
        };
        CHECK(std::abs(weighted(a + 3, sensitive_block)) <= 1e-14 * size_w);
        CHECK(std::abs(weighted(b + 3, sensitive_block)) <= 1e-14 * size_q);
        CHECK(std::abs(weighted(a, omega) - (w[r] + t * a[6])) <= 1e-14 * size_w * (1 + omega.norm()));
        CHECK(std::abs(weighted(b, omega) - t * b[6]) <= 1e-14 * size_q * (1 + omega.norm()));
      }
    }
  }
}

TEST_CASE("a batch is each body, for any number of threads") {
  constexpr std::size_t n = 300;
  std::vector<double> moments, omega, attitude, t;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = static_cast<double>(i) / n;
    for (const double v : {0.5 + 0.1 * x, 0.7 - 0.15 * x, 0.8}) moments.push_back(v);
    for (const double v : {1.0 - 2 * x, 2.0 * x * x, 0.3 + x}) omega.push_back(v);
    for (const double v : {0.0, 0.6, 0.0, 0.8}) attitude.push_back(v);
    t.push_back(100 * x - 20);
  }
  FreeMotionBatch batch;
  batch.bodies = n, batch.times = 1, batch.own_times = true;
  batch.moments = moments.data(), batch.omega = omega.data(), batch.attitude = attitude.data(), batch.t = t.data();
  std::vector<double> one_w(18 * n), one_q(18 * n), two_w(18 * n), two_q(18 * n);
  const std::vector<SensitivityTo> wrt = {SensitivityTo::omega, SensitivityTo::inertia};
  CHECK(free_sensitivity(batch, wrt, RotationSide::space, nullptr, nullptr, one_w.data(), one_q.data(), 1) == 0);
  CHECK(free_sensitivity(batch, wrt, RotationSide::space, nullptr, nullptr, two_w.data(), two_q.data(), 3) == 0);
  CHECK(one_w == two_w);
  CHECK(one_q == two_q);
  for (std::size_t i = 0; i < n; i += 7) {
    const FreeMotion motion(Vector3d(moments[3 * i], moments[3 * i + 1], moments[3 * i + 2]),
                            Vector3d(omega[3 * i], omega[3 * i + 1], omega[3 * i + 2]), {0, 0.6, 0, 0.8});
    double d_w[18], d_q[18];
    FreeSensitivity(motion, wrt).at(&t[i], 1, nullptr, nullptr, d_w, d_q);
    double largest = 0;
    for (const double v : d_w) largest = std::max(largest, std::abs(v));
    for (std::size_t k = 0; k < 18; ++k) CHECK(std::abs(d_w[k] - one_w[18 * i + k]) <= 1e-13 * largest);
  }
}

TEST_CASE("names of columns are checked") {
  const FreeMotion motion(sensitive_block, {1, 2, 3});
  CHECK_THROWS_AS(FreeSensitivity(motion, {}), InvalidInput);
  CHECK_THROWS_AS(FreeSensitivity(motion, {SensitivityTo::time, SensitivityTo::time}), InvalidInput);
}

TEST_CASE("columns of a free body are differences of the motion") {
  const Vector3d moments{0.30, 0.40, 0.52}, omega{1, 2, 3};
  const double t = 2.5, d = 1e-5;
  const auto at = [&](const Vector3d& J, const Vector3d& w) {
    return FreeMotion(J, w, sensitive_start).at(t);
  };
  double w[3], q[4], d_w[18], d_q[18];
  const FreeSensitivity columns(FreeMotion(moments, omega, sensitive_start),
                                {SensitivityTo::omega, SensitivityTo::inertia});
  columns.at(&t, 1, w, q, d_w, d_q);
  for (int c = 0; c < 6; ++c) {
    const Vector3d step = d * Vector3d::Unit(c % 3), none = Vector3d::Zero();
    const State plus = at(moments + (c < 3 ? none : step), omega + (c < 3 ? step : none));
    const State minus = at(moments - (c < 3 ? none : step), omega - (c < 3 ? step : none));
    Quat turned = plus.attitude * conjugate(minus.attitude);
    const double sign = turned.w < 0 ? -1 : 1, turn[3] = {turned.x, turned.y, turned.z};
    for (int r = 0; r < 3; ++r) {
      CHECK(d_w[6 * r + c] == doctest::Approx((plus.omega[r] - minus.omega[r]) / (2 * d)).epsilon(1e-6));
      CHECK(d_q[6 * r + c] == doctest::Approx(sign * turn[r] / d).epsilon(1e-6));
    }
  }
}
