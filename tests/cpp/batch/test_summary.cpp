#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "polhode/math/draw.hpp"
#include "polhode/batch/summary.hpp"
#include "polhode/core/error.hpp"
#include "polhode/math/detail/philox.hpp"

using namespace polhode;

TEST_CASE("Philox has the published words") {
  // Random123, kat_vectors: philox4x64 10.
  CHECK(math::philox({0, 0, 0, 0}, {0, 0}) ==
        std::array<std::uint64_t, 4>{0x16554d9eca36314cu, 0xdb20fe9d672d0fdcu, 0xd7e772cee186176bu,
                                     0x7e68b68aec7ba23bu});
}

TEST_CASE("a draw depends on the body alone") {
  const double parameters[] = {0.0, 1.0, 2.0, 0.5};
  const Draw normal(Distribution::normal, parameters, 2, 2);
  const DrawStream stream{8, draw_key("start.omega"), 0};
  std::vector<double> all(200), part(100);
  normal(stream, 0, 100, all.data());
  normal(stream, 50, 50, part.data());
  CHECK(std::vector<double>(all.begin() + 100, all.end()) == part);
  CHECK_THROWS_AS(Draw(Distribution::uniform, parameters, 1, 4), InvalidInput);
}

TEST_CASE("a summary counts what fails, and its bits do not depend on the cut") {
  constexpr std::size_t n = 5000, times = 3;
  std::vector<double> moments, omega, attitude;
  for (std::size_t i = 0; i < n; ++i) {
    const double x = 0.001 * static_cast<double>(i);
    for (const double v : {1.0, 1.5, 2.0 + 0.1 * x}) moments.push_back(i == 70 ? -v : v);
    for (const double v : {0.1, 1.0 + x, 0.2}) omega.push_back(v);
    for (const double v : {0.0, 0.0, 0.0, 1.0}) attitude.push_back(v);
  }
  const std::vector<double> t = {0.0, 0.5, 2.0};
  const FreeMotionBatch batch{.bodies = n, .times = times, .moments = moments.data(), .omega = omega.data(),
                              .attitude = attitude.data(), .t = t.data()};
  SummaryQuantity rate, angle;
  rate.of = SummaryQuantity::Of::omega;
  angle.reference = {0.0, 0.0, 0.0, 1.0};
  Summary whole({rate, angle}, times), cut({rate, angle}, times);
  whole.add_free(0, batch, 2);
  FreeMotionBatch first = batch, second = batch;
  first.bodies = 1000, second.bodies = n - 1000;
  second.moments += 3000, second.omega += 3000, second.attitude += 4000;
  cut.add_free(0, first), cut.add_free(1000, second);
  const Summary::Record a = whole.record(), b = cut.record();
  CHECK(a.failed == 1);
  CHECK(a.bodies == n);
  double sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) sum += i == 70 ? 0.0 : std::sqrt(0.05 + omega[3 * i + 1] * omega[3 * i + 1]);
  CHECK(a.quantities[0].sum[0] == doctest::Approx(sum).epsilon(1e-13));
  CHECK(a.quantities[0].count[2] == n - 1);
  CHECK(a.quantities[1].largest[0] < 2e-15);
  for (std::size_t q = 0; q < 2; ++q) {
    CHECK(a.quantities[q].sum == b.quantities[q].sum);
    CHECK(a.quantities[q].sum2 == b.quantities[q].sum2);
    CHECK(a.quantities[q].histogram == b.quantities[q].histogram);
  }
  CHECK_THROWS_AS(cut.add_free(0, first), InvalidInput);
}

TEST_CASE("the mean attitude of two turns lies between them") {
  // cos and sin of 0.1, about z to both sides: the mean is no turn, the spread 0.2 rad.
  const double c = 0.9950041652780258, s = 0.09983341664682815;
  const double moments[] = {0, 0, 0, 0, 0, 0, 0, 2 * s * s, 0, 2 * c * c};
  const MeanAttitude mean = mean_attitude(moments);
  CHECK(mean.attitude[3] == doctest::Approx(1.0).epsilon(1e-15));
  CHECK(mean.spread == doctest::Approx(0.2).epsilon(1e-14));
}
