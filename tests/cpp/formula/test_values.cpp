#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "formula_table.hpp"
#include "polhode/formula/detail/functions.hpp"
#include "polhode/formula/program.hpp"
#include "polhode/formula/trace.hpp"

using namespace polhode;
using namespace polhode::formula;

namespace {

bool same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

}  // namespace

TEST_CASE("formula: values against mpmath, as text and printed again") {
  int count = 0;
  for (const TableCase& c : read_formulas()) {
    if (c.values.empty()) continue;
    ++count;
    const Program program = parse(c.text);
    Evaluator evaluator(program);
    double found[5];
    const std::vector<double> parameters = list_values(program.parameters);
    evaluator(c.t, c.y.data(), parameters.data(), found);
    CAPTURE(c.text.torque);
    for (std::size_t i = 0; i < 5; ++i) {
      CAPTURE(i);
      CHECK(std::abs(found[i] - c.values[i]) <= 0x1p-52 * (c.errors[i] + std::abs(c.values[i])));
    }
    const Program again = parse(print(program));
    CHECK(is_same(program, again));
    // Bound parameters round the same constants in another place.
    const Program bound = bind_parameters(program, parameters);
    CHECK(bound.parameters.empty());
    double other[5];
    Evaluator evaluate_bound(bound);
    evaluate_bound(c.t, c.y.data(), nullptr, other);
    for (std::size_t i = 0; i < 5; ++i)
      CHECK(std::abs(other[i] - c.values[i]) <= 0x1p-52 * (c.errors[i] + std::abs(c.values[i])));
  }
  CHECK(count == 60);
}

TEST_CASE("formula: sums, constant factors and crosses with constants are no operations") {
  const Program heavy = trace([](const auto& in) {
    using T = std::decay_t<decltype(in.t)>;
    const Vec<T, 3> moment{{T(0.6), T(0.4), T(1.0)}}, up{{T(0.0), T(0.0), T(1.0)}};
    return -cross(moment, to_body(in.attitude, up));
  });
  int operations = 0;
  for (int i = 0; i < heavy.graph.size(); ++i)
    if (heavy.graph[i].op != Op::state && heavy.graph[i].op != Op::constant) ++operations;
  CHECK(operations == 3);   // the components of R^T e_z
  const Program zero = trace([](const auto& in) { return in.omega * in.t - in.t * in.omega; });
  CHECK(zero.graph.size() == 0);
  CHECK(zero.outputs[0].is_zero());
}

TEST_CASE("formula: a lambda gives the same on numbers and on symbols") {
  const std::vector<Input> parameters{{"kp", {0.2}}, {"kd", {0.5, 0.5, 0.4}}}, states{{"h", {0.1, 0.2, 0.3}}};
  const auto wheels = [](const auto& in) {
    using T = std::decay_t<decltype(in.t)>;
    const Vec<T, 3> command = in.attitude.xyz() * (-in.p("kp") * in.attitude.w()) -
                              in.template p<3>("kd") * in.omega;
    Vec<T, 3> u;
    for (std::size_t i = 0; i < 3; ++i)
      u[i] = clip(command[i], T(-0.05), T(0.05)) + formula::tanh(in.omega[i]) / norm(in.omega);
    return TorqueResult<T>{u - cross(in.omega, in.template s<3>("h")), {-u[0], -u[1], -u[2]}};
  };
  const Program program = trace(wheels, parameters, states);
  const double y[10] = {0.3, -0.2, 0.5, 0.1, 0.5, 0.7, 0.5, 0.1, 0.2, 0.3};
  double found[6];
  Evaluator evaluator(program);
  evaluator(0.0, y, list_values(parameters).data(), found);
  TorqueArguments<double> in(parameters, list_values(parameters), states, {0.1, 0.2, 0.3});
  in.omega = {{y[0], y[1], y[2]}}, in.attitude = {{y[3], y[4], y[5], y[6]}};
  const TorqueResult<double> truth = wheels(in);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(found[i] == doctest::Approx(truth.torque[i]).epsilon(1e-14));
    CHECK(found[3 + i] == doctest::Approx(truth.rates[i]).epsilon(1e-14));
  }
  CHECK(is_same(program, parse(print(program))));
}

TEST_CASE("formula: tanh keeps its slope where it is near 1, and its sign") {
  for (const double x : {1e-300, 1e-8, 0.1, 0.349999, 0.350001, 1.0, 5.0, 19.0, 40.0, 300.0}) {
    const TanhPair pair = compute_tanh(x);
    const long double e = std::exp(-2.0L * x), truth = -std::expm1(-2.0L * x) / (1.0L + e);
    const long double slope = 4.0L * e / ((1.0L + e) * (1.0L + e));
    CHECK(std::abs(pair.value - static_cast<double>(truth)) <= 4e-16 * pair.value);
    CHECK(std::abs(pair.slope - static_cast<double>(slope)) <= 2e-15 * pair.slope);
    CHECK(same_bits(compute_tanh(-x).value, -pair.value));
  }
  CHECK(compute_tanh(std::numeric_limits<double>::infinity()).value == 1.0);
  CHECK(std::isnan(compute_tanh(std::numeric_limits<double>::quiet_NaN()).value));
}
