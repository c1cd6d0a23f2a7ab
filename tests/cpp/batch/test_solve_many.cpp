#include "polhode/batch/solve_many.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <string_view>

#include "polhode/core/error.hpp"

namespace polhode {
namespace {

Scene make_body(std::size_t i) {
  const double spin = 0.5 + 0.01 * static_cast<double>(i);
  return Scene(SceneParts{
      .inertia_B = InertiaTensor::from_moments({1.0, 1.5, 2.0}), .omega = {0.1, spin, 0.3}, .times = {1.0, 2000.0}});
}

Scene make_tilted(std::size_t) {
  return Scene(SceneParts{.inertia_B = InertiaTensor::from_moments({1.0, 1.5, 2.0}), .omega = {0.0, 0.0, 0.5},
                          .attitude = {0.6, 0.0, 0.0, 0.8}, .times = {0.5, 1.0}});
}

}  // namespace

TEST_CASE("solve_many: a callback stops bodies in lanes, and the rows they reached are kept") {
  constexpr std::size_t n = 200;
  SolveOptions options;
  SUBCASE("taylor") { options.method = "taylor"; }
  SUBCASE("rk45") { options.method = "rk45"; }
  options.rtol = 1e-12;
  std::atomic<int> calls{0};
  options.progress = [&](double, double) { return ++calls < 3; };
  std::vector<double> omega(n * 2 * 3);
  const std::vector<ManyResult> results = solve_many(n, 2, make_body, options, omega.data(), nullptr, 2);
  int stopped = 0;
  for (std::size_t i = 0; i < n; ++i) {
    CHECK((results[i].status == Status::stopped || results[i].status == Status::finished));
    stopped += results[i].status == Status::stopped;
    CHECK(results[i].success == (results[i].status == Status::finished));
    CHECK(std::isnan(omega[6 * i + 3]) == (results[i].status == Status::stopped));
    if (results[i].t_reached >= 1.0) CHECK(std::isfinite(omega[6 * i]));
  }
  CHECK(stopped > 100);
}

TEST_CASE("solve_many: lanes run taylor and rk45 only, and options are checked as by solve()") {
  SolveOptions options;
  options.rtol = 1e-9;
  for (const char* method : {"taylor", "rk45", "dop853", "rk45 of angles"}) {
    const bool angles = std::string_view(method).ends_with("angles");
    options.method = angles ? "rk45" : method;
    options.formulation = angles ? Formulation::lagrangian : Formulation::euler;
    double omega[2 * 2 * 3];
    const auto results = solve_many(2, 2, angles ? make_tilted : make_body, options, omega, nullptr);
    CHECK(results[1].lanes == (!angles && options.method != "dop853"));
    CHECK(results[1].method == options.method);
    CHECK(results[1].status == Status::finished);
  }
  options.formulation = Formulation::euler;
  options.method = "taylor", options.step = 0.1;
  CHECK_THROWS_AS(solve_many(2, 2, make_body, options, nullptr, nullptr), InvalidInput);
  options.step.reset(), options.max_steps = 0;
  CHECK_THROWS_AS(solve_many(2, 2, make_body, options, nullptr, nullptr), InvalidInput);
}

}  // namespace polhode
