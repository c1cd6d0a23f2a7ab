#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "formula_table.hpp"
#include "polhode/formula/derivative.hpp"

using namespace polhode;
using namespace polhode::formula;

TEST_CASE("formula: derivatives by states and parameters against mpmath") {
  std::vector<Variable> variables;
  for (int i = 0; i < 9; ++i) variables.push_back({Variable::Kind::state, i});
  for (int i = 0; i < 2; ++i) variables.push_back({Variable::Kind::parameter, i});
  int count = 0;
  for (const TableCase& c : read_formulas()) {
    if (c.values.empty()) continue;
    ++count;
    CAPTURE(c.text.torque);
    const Program program = differentiate(parse(c.text), variables);
    REQUIRE(program.outputs.size() == 60);
    std::vector<double> found(60);
    Evaluator evaluator(program);
    evaluator(c.t, c.y.data(), list_values(program.parameters).data(), found.data());
    for (std::size_t output = 0; output < 5; ++output) {
      double size = std::abs(c.values[output]) + c.errors[output];
      for (const auto& slopes : c.slopes) size = std::max(size, std::abs(slopes[output]));
      for (std::size_t v = 0; v < 11; ++v) {
        CAPTURE(v);
        CHECK(std::abs(found[5 * (v + 1) + output] - c.slopes[v][output]) <= 1e-14 * size);
      }
    }
  }
  CHECK(count == 60);
}

TEST_CASE("formula: derivatives by a small rotation against differences") {
  const Program torque = parse({"attitude.w * attitude.xyz + cross([1, 2, 3] * u, u) + omega * attitude.y", {}, {}, {},
                                {{"u", "to_body([cos(t), 0.5, omega.x])"}}});
  const Program program = differentiate(
      torque, {{Variable::Kind::rotation, 0}, {Variable::Kind::rotation, 1}, {Variable::Kind::rotation, 2}});
  const Quat q{0.1, 0.5, 0.7, 0.5};
  const auto compute = [&](const Quat& attitude) {
    const double y[7] = {0.3, -0.2, 0.5, attitude.x, attitude.y, attitude.z, attitude.w};
    std::vector<double> outputs(12);
    Evaluator evaluator(program);
    evaluator(0.75, y, nullptr, outputs.data());
    return outputs;
  };
  const std::vector<double> found = compute(q);
  for (int axis = 0; axis < 3; ++axis) {
    const double h = 1e-3;
    std::vector<double> at[4];
    const double steps[4] = {-2 * h, -h, h, 2 * h};
    for (int k = 0; k < 4; ++k) {
      Vector3d e = Vector3d::Zero();
      e[axis] = std::sin(steps[k] / 2);
      at[k] = compute(q * Quat{e[0], e[1], e[2], std::cos(steps[k] / 2)});
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const double slope = (at[0][i] - 8 * at[1][i] + 8 * at[2][i] - at[3][i]) / (12 * h);
      CHECK(found[3 * static_cast<std::size_t>(axis + 1) + i] == doctest::Approx(slope).epsilon(1e-10));
    }
  }
}

TEST_CASE("formula: derivatives of a heavy body share the vertical") {
  const Program torque = parse({"-cross([0.6, 0.4, 1], to_body([0, 0, 1]))", {}, {}, {}, {}});
  std::vector<Variable> rotations;
  for (int i = 0; i < 3; ++i) rotations.push_back({Variable::Kind::rotation, i});
  const Program program = differentiate(torque, rotations);
  for (int i = 0; i < program.graph.size(); ++i) CHECK(program.graph[i].op != Op::multiply);
}
