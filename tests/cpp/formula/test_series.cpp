#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "formula_table.hpp"
#include "polhode/core/error.hpp"
#include "polhode/formula/modes.hpp"
#include "polhode/formula/tape.hpp"

using namespace polhode;
using namespace polhode::formula;

namespace {

double largest(const std::vector<double>& row) {
  double size = 0.0;
  for (const double x : row) size = std::max(size, std::abs(x));
  return size;
}

Tape make_tape(const TableCase& c) {
  const Program torque = bind_parameters(parse(c.text), {0.375, -1.25});
  const Program system = make_body_equations(torque, make_inertia(c.diagonal));
  return Tape(in_mode(system, find_mode(system, c.t, c.y.data())));
}

Program parse_torque(const std::string& torque) { return parse({torque, {}, {}, {}, {}}); }

}  // namespace

TEST_CASE("formula: Taylor series of motions against mpmath") {
  int count = 0;
  for (const TableCase& c : read_formulas()) {
    if (c.rows.empty()) continue;
    ++count;
    CAPTURE(c.text.torque);
    const Tape tape = make_tape(c);
    const int order = static_cast<int>(c.rows.size()) - 1;
    REQUIRE(tape.states() == 9);
    for (const Rounding rounding : {Rounding::fused, Rounding::plain}) {
      for (const double unit : {1.0, 0x1p-5}) {
        std::vector<double> rows(9 * c.rows.size());
        compute_series(tape, rounding, c.t, unit, c.y.data(), order, rows.data());
        for (int n = 0; n <= order; ++n) {
          const auto at = static_cast<std::size_t>(n);
          // Rounding errors of a row are relative to the largest coefficients near it.
          double size = largest(c.rows[at]);
          if (n > 0) size = std::max(size, largest(c.rows[at - 1]));
          CAPTURE(n);
          for (std::size_t i = 0; i < 9; ++i) {
            const double found = rows[9 * at + i] / std::pow(unit, n);
            CHECK(std::abs(found - c.rows[at][i]) <= 0x1p-53 * 60 * (n + 1) * size);
          }
        }
      }
    }
  }
  CHECK(count == 40);
}

TEST_CASE("formula: operations of the heavy body and of the gravity gradient") {
  const Vector3d moments(1.0, 2.0, 2.5);
  const Program heavy = parse_torque("-cross([0.6, 0.4, 1], to_body([0, 0, 1]))");
  const Tape tape(make_body_equations(heavy, moments.asDiagonal()));
  CHECK(tape.operations().size() == 21);
  CHECK(tape.count(Rule::product) == 21);
  CHECK(tape.forms().empty());
  Text text{"3 * n^2 * cross(u, [20, 40, 52] * u)", {{"n", {1e-3}}}, {}, {},
            {{"u", "to_body([cos(n * t), sin(n * t), 0])"}}};
  const Tape gradient(make_body_equations(bind_parameters(parse(text), {1e-3}), Vector3d(20, 40, 52).asDiagonal()));
  CHECK(gradient.operations().size() == 30);
  CHECK(gradient.state_slots().size() == 13);
  CHECK(gradient.waves().empty());
}

TEST_CASE("formula: a tape refuses parameters and switches") {
  Text text{"-kd * omega", {{"kd", {0.5}}}, {}, {}, {}};
  CHECK_THROWS_AS(Tape(make_body_equations(parse(text), Matrix3d::Identity())), InvalidInput);
  CHECK_THROWS_AS(Tape(make_body_equations(parse_torque("abs(omega)"), Matrix3d::Identity())), InvalidInput);
}
