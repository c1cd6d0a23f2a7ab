#include <doctest/doctest.h>

#include <cstdlib>
#include <cstring>
#include <memory>

#include "formula_table.hpp"
#include "polhode/core/simd.hpp"
#include "polhode/formula/modes.hpp"
#include "polhode/formula/table.hpp"

using namespace polhode;
using namespace polhode::formula;

namespace {

std::vector<SimdLevel> levels() {
  std::vector<SimdLevel> found{SimdLevel::baseline};
  if (simd_level() != SimdLevel::baseline) found.push_back(SimdLevel::avx2);
  if (simd_level() == SimdLevel::avx512) found.push_back(SimdLevel::avx512);
  return found;
}

struct Free {
  void operator()(double* p) const { std::free(p); }
};

/// Rows and extras of a table have the bits of the tape's, at each level.
void check_bits(const Table& table, double t, double unit, const double* y, int order) {
  const Tape& tape = table.tape();
  const auto rows = static_cast<std::size_t>(order) + 1;
  const std::size_t bytes = (8 * table.workspace_size(order) + 63) / 64 * 64;
  const std::unique_ptr<double, Free> workspace(static_cast<double*>(std::aligned_alloc(64, bytes)));
  for (const SimdLevel level : levels()) {
    CAPTURE(to_text(level));
    std::vector<double> truth(rows * static_cast<std::size_t>(tape.states())),
        truth_extras(rows * static_cast<std::size_t>(tape.extras()));
    compute_series(tape, Table::rounding(level), t, unit, y, order, truth.data(), truth_extras.data());
    std::vector<double> found(rows * static_cast<std::size_t>(table.width())),
        extras(rows * static_cast<std::size_t>(table.extra_width()));
    std::memset(workspace.get(), 0xff, bytes);   // NaN: what is read must have been written
    table.compute_series(level, t, unit, y, order, found.data(), extras.data(), workspace.get());
    int different = 0;
    for (std::size_t n = 0; n < rows; ++n) {
      for (int i = 0; i < tape.states(); ++i) {
        const double a = truth[n * static_cast<std::size_t>(tape.states()) + static_cast<std::size_t>(i)];
        const double b = found[n * static_cast<std::size_t>(table.width()) +
                               static_cast<std::size_t>(Table::column_of(i))];
        different += std::memcmp(&a, &b, sizeof a) != 0;
      }
      for (int i = 0; i < tape.extras(); ++i) {
        const double a = truth_extras[n * static_cast<std::size_t>(tape.extras()) + static_cast<std::size_t>(i)];
        const double b = extras[n * static_cast<std::size_t>(table.extra_width()) + static_cast<std::size_t>(i)];
        different += std::memcmp(&a, &b, sizeof a) != 0;
      }
      CHECK(found[n * static_cast<std::size_t>(table.width()) + 3] == 0.0);
    }
    CHECK(different == 0);
  }
}

}  // namespace

TEST_CASE("formula: tables have the bits of the reference at each level") {
  int count = 0;
  for (const TableCase& c : read_formulas()) {
    if (c.rows.empty()) continue;
    ++count;
    CAPTURE(c.text.torque);
    const Program torque = bind_parameters(parse(c.text), {0.375, -1.25});
    const Program system = make_body_equations(torque, make_inertia(c.diagonal));
    const Program smooth = in_mode(system, find_mode(system, c.t, c.y.data()), true);
    for (const int order : {1, 2, 3, 4, 5, 8, 15, 22}) {
      CAPTURE(order);
      check_bits(Table(Tape(smooth, 9)), c.t, 0.25, c.y.data(), order);
    }
  }
  CHECK(count == 40);
}

TEST_CASE("formula: the packing of two bodies, which decides their speed") {
  const auto make = [](const Text& text, const Vector3d& moments) {
    return Table(Tape(make_body_equations(parse(text), moments.asDiagonal())));
  };
  const Table heavy = make({"-cross([0.6, 0.4, 1], to_body([0, 0, 1]))", {}, {}, {}, {}}, {1.0, 2.0, 2.5});
  CHECK(heavy.count_picks() <= 11);
  CHECK(heavy.parts().stores == 3);
  const Table gradient = make({"3e-6 * cross(u, [20, 40, 52] * u)", {}, {}, {},
                               {{"u", "to_body([cos(1e-3 * t), sin(1e-3 * t), 0])"}}},
                              {20, 40, 52});
  CHECK(gradient.count_picks() <= 14);
  CHECK(gradient.parts().stores == 4);
  const double y[7] = {0.002, 0.004, 0.006, 0.5, 0.5, -0.5, 0.5};
  check_bits(gradient, 1234.5, 64.0, y, 15);
}
