#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "formula_table.hpp"
#include "polhode/core/error.hpp"
#include "polhode/formula/modes.hpp"
#include "polhode/formula/tape.hpp"
#include "polhode/math/detail/double_double.hpp"

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

TEST_CASE("formula: a wave keeps its angle after many revolutions, and its rows") {
  const double phase = 0.3, rate = 1.1, unit = 0.25;
  for (const math::DD t : {math::DD(0.7), math::DD(1e9, 3e-8), math::DD(-3e7, 1e-9)}) {
    const math::DD angle = math::two_prod(rate, t.hi) + math::DD(rate * t.lo) + math::DD(phase);
    const math::SinCos truth = math::sincos(angle);
    const double cycle[4] = {truth.sin.hi, truth.cos.hi, -truth.sin.hi, -truth.cos.hi};
    double sine[7], cosine[7], factor = 1.0;
    fill_wave({phase, rate, false}, t, unit, 6, sine, 1);
    fill_wave({phase, rate, true}, t, unit, 6, cosine, 1);
    for (int n = 0; n <= 6; ++n) {
      if (n > 0) factor *= rate * unit / n;
      CHECK(std::abs(sine[n] - factor * cycle[n % 4]) <= 4e-16 * factor * (n + 1));
      CHECK(std::abs(cosine[n] - factor * cycle[(n + 1) % 4]) <= 4e-16 * factor * (n + 1));
    }
  }
}

TEST_CASE("formula: guards have series of their own") {
  const Program torque = parse_torque("clip(-omega.x - 2 * attitude.y, -0.5, 0.5) * [1, 2, 3]");
  const Program system = make_body_equations(torque, Vector3d(1.0, 2.0, 2.5).asDiagonal());
  const double y[7] = {0.1, 0.2, 0.3, 0.5, 0.1, -0.5, 0.7};
  const Mode mode = find_mode(system, 0.0, y);
  const Tape tape(in_mode(system, mode, true), 7);
  REQUIRE(tape.extras() == 2);
  constexpr int order = 6;
  double rows[7 * (order + 1)], extras[2 * (order + 1)];
  compute_series(tape, Rounding::fused, 0.0, 1.0, y, order, rows, extras);
  // u = -w_x - 2 q_y: of max(u, low) the guard is u - low, of min(that, high) in this mode u - high.
  for (int n = 0; n <= order; ++n) {
    const double u = -rows[7 * n] - 2 * rows[7 * n + 4], low = n == 0 ? -0.5 : 0.0;
    const double size = std::abs(rows[7 * n]) + 2 * std::abs(rows[7 * n + 4]) + std::abs(low);
    CHECK(std::abs(2 * extras[2 * n] - (u - low)) <= 1e-15 * size);   // its largest coefficient is made 1
    CHECK(std::abs(extras[2 * n + 1] - (u + low)) <= 1e-15 * size);
  }
}

TEST_CASE("formula: a tape refuses parameters and switches") {
  Text text{"-kd * omega", {{"kd", {0.5}}}, {}, {}, {}};
  CHECK_THROWS_AS(Tape(make_body_equations(parse(text), Matrix3d::Identity())), InvalidInput);
  CHECK_THROWS_AS(Tape(make_body_equations(parse_torque("abs(omega)"), Matrix3d::Identity())), InvalidInput);
}
