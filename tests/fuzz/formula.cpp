#include <cstdlib>
#include <string>

#include "polhode/formula/derivative.hpp"
#include "polhode/formula/facts.hpp"
#include "polhode/formula/modes.hpp"
#include "polhode/formula/parser.hpp"
#include "polhode/formula/recognise.hpp"
#include "polhode/formula/table.hpp"

#include "input.hpp"

// Texts of formulas: refused in one line, or programs that print themselves, and whose tables have the bits of tapes.

namespace polhode::fuzz {
namespace {

namespace f = formula;

constexpr const char* words[] = {"omega", "attitude", "t", "kp", "h", "u", "+", "-", "*", "/", "^", "(", ")", "[", "]",
                                 ",", ".xyz", ".x", ".w", "[1]", "<", ">", "0", "1", "2", "0.5", "1e-3", "1e300",
                                 "sqrt(", "tanh(", "exp(", "log(", "sin(", "cos(", "atan2(", "where(", "abs(", "clip(", "norm(",
                                 "cross(", "dot(", "to_body(", "to_space(", "min(", " ", "\n"};

/// Words of the language, or bytes.
std::string draw_text(Input& input) {
  std::string text;
  const std::size_t count = input.below(64);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t kind = input.take<std::uint8_t>();
    if (kind < 250) text += words[kind % std::size(words)];
    else text += static_cast<char>(input.take<std::uint8_t>());
  }
  return text;
}

void try_series(const f::Program& torque, const double* y) {
  const f::Program bound = f::bind_parameters(torque, f::list_values(torque.parameters));
  const f::Program system = f::make_body_equations(bound, Vector3d(1.0, 2.0, 2.5).asDiagonal());
  const f::Table table(f::Tape(f::in_mode(system, f::find_mode(system, 0.5, y))));
  constexpr int order = 6;
  const auto states = static_cast<std::size_t>(table.tape().states()), width = static_cast<std::size_t>(table.width());
  std::vector<double> truth((order + 1) * states), rows((order + 1) * width);
  f::compute_series(table.tape(), f::Table::rounding(SimdLevel::baseline), 0.5, 0.25, y, order, truth.data());
  const std::size_t size = (table.workspace_size(order) + 7) / 8 * 8;
  double* workspace = static_cast<double*>(std::aligned_alloc(64, 8 * size));
  table.compute_series(SimdLevel::baseline, 0.5, 0.25, y, order, rows.data(), nullptr, workspace);
  std::free(workspace);
  bool finite = true;
  for (const double x : truth) finite = finite && x - x == 0.0;
  for (std::size_t n = 0; finite && n <= order; ++n) {
    for (std::size_t i = 0; i < states; ++i) {
      const auto column = static_cast<std::size_t>(f::Table::column_of(static_cast<int>(i)));
      require(is_same(truth[n * states + i], rows[n * width + column]), "a table has the bits of its tape");
    }
  }
}

}  // namespace
}  // namespace polhode::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using polhode::fuzz::draw_text, polhode::fuzz::is_done, polhode::fuzz::require;
  namespace f = polhode::formula;
  polhode::fuzz::Input input(data, size);
  const double y[9] = {0.3, -0.2, 0.5, 0.1, 0.5, 0.7, 0.5, 0.25, -0.5};
  f::Text text;
  text.parameters = {{"kp", {0.375}}};
  text.states = {{"h", {y[7], y[8]}}};
  if (input.coin()) {
    text.rates = {"h"};
  } else {
    text.rates = {draw_text(input)};
  }
  if (input.coin()) text.let.emplace_back("u", draw_text(input));
  text.torque = "omega + " + draw_text(input);
  is_done([&] {
    const f::Program program = f::parse(text);
    const bool printed = is_done([&] {
      require(f::is_same(program, f::parse(f::print(program))), "a program is what it prints");
    });
    require(printed, "what a program prints is taken");
    f::find_facts(program);
    is_done([&] {
      f::differentiate(program, {{f::Variable::Kind::rotation, 0}, {f::Variable::Kind::state, 7}});
    });
    is_done([&] { f::recognise(f::bind_parameters(program, {0.375}), polhode::Matrix3d::Identity()); });
    is_done([&] { polhode::fuzz::try_series(program, y); });
  });
  return 0;
}
