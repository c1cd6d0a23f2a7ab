#include "solve/proof/formula_modes.hpp"

#include <algorithm>
#include <utility>

#include "polhode/formula/modes.hpp"
#include "solve/proof/interval_program.hpp"

namespace polhode::proof {

using formula::Form;
using formula::Side;

namespace {

Form form_of(const formula::Graph& graph, int node) {
  if (graph[node].op == formula::Op::constant) return graph[node].constant;
  return graph[node].op == formula::Op::linear ? graph.linear(node) : Form::of(node);
}

bool is_multiple(const Form& a, const Form& of) {
  if (a.is_zero()) return true;
  if (a.terms.empty() || of.terms.empty()) return false;
  const double factor = a.terms[0].factor / of.terms[0].factor;
  return a == of * factor;
}

}  // namespace

FormulaModes::FormulaModes(FormulaEquations equations, const StepSettings& settings)
    : equations_(std::move(equations)), settings_(settings),
      guards_(formula::list_sided_guards(equations_.program)) {
  find_kinks(), find_needs();
}

void FormulaModes::find_kinks() {
  const formula::Graph& graph = equations_.program.graph;
  kinks_.assign(count_guards(), true);
  for (const int node : formula::list_switches(equations_.program)) {
    const auto [guard, yes, no] = graph[node].operands;
    if (!is_multiple(form_of(graph, yes) - form_of(graph, no), form_of(graph, guard)))
      kinks_[guards_.find(graph, guard).number] = false;
  }
}

void FormulaModes::find_needs() {
  const formula::Graph& graph = equations_.program.graph;
  needs_.assign(count_guards(), std::vector<bool>(count_guards(), false));
  for (std::size_t i = 0; i < count_guards(); ++i) {
    const std::vector<bool> live = formula::find_live(graph, {guards_.forms[i]});
    for (int node = 0; node < graph.size(); ++node)
      if (live[to_index(node)] && graph[node].op == formula::Op::choose)
        needs_[i][guards_.find(graph, graph[node].operands[0]).number] = true;
  }
}

FormulaModes::Mode& FormulaModes::find(const Sides& sides) {
  std::unique_ptr<Mode>& found = modes_[sides];
  if (found) return *found;
  formula::ModeProgram mode = formula::make_mode(equations_.program, sides);
  std::vector<int> numbers;
  for (const formula::ActiveGuard& guard : mode.guards) numbers.push_back(guard.number);
  FormulaSystem system = differentiate(equations_, mode.program);
  found = std::make_unique<Mode>(Mode{std::move(numbers), FormulaStep(system, settings_), std::move(system.surface)});
  return *found;
}

FormulaModes::Values FormulaModes::evaluate(const Mode& mode, const Interval& time,
                                            const std::vector<Interval>& variables) const {
  const auto n = to_index(equations_.size), count = mode.guards.size();
  std::vector<Interval> states(formula::first_extra + n);
  for (int i = 0; i < static_cast<int>(states.size()); ++i) {
    const int variable = equations_.find_variable(i);
    const bool is_attitude = formula::first_attitude <= i && i < formula::first_extra;
    if ((!is_attitude || equations_.has_attitude) && variable < equations_.size)
      states[to_index(i)] = variables[to_index(variable)];
  }
  const Interval seconds = Interval(equations_.t0) + time * Interval(equations_.per_time);
  const std::vector<Interval> all = proof::evaluate(mode.surface, seconds, states, equations_.values);
  const auto take = [&](std::size_t first, std::size_t size) {
    return std::vector<Interval>(all.begin() + static_cast<std::ptrdiff_t>(first),
                                 all.begin() + static_cast<std::ptrdiff_t>(first + size));
  };
  Values values{.rates = take(0, n), .guards = take(n, count), .slopes = {}, .speeds = {}};
  const std::size_t slopes = n + count;
  for (std::size_t g = 0; g < count; ++g) {
    std::vector<Interval> row;
    for (std::size_t v = 0; v < n; ++v) row.push_back(all[slopes + count * v + g]);
    Interval speed = all[slopes + count * n + g] * Interval(equations_.per_time);
    for (std::size_t v = 0; v < n; ++v) speed = speed + row[v] * values.rates[v];
    values.slopes.push_back(std::move(row)), values.speeds.push_back(speed);
  }
  return values;
}

std::vector<int> FormulaModes::settle(Sides& sides, const std::vector<int>& open, const Interval& time,
                                      const std::vector<Interval>& variables) {
  // A guard that another one brings in may bring in a third.
  for (std::size_t round = 0;; ++round) {
    const Mode& mode = find(sides);
    const Values values = evaluate(mode, time, variables);
    std::vector<int> unsettled;
    bool changed = false;
    for (std::size_t i = 0; i < mode.guards.size(); ++i) {
      const int number = mode.guards[i];
      if (std::find(open.begin(), open.end(), number) != open.end()) continue;
      const Interval& guard = values.guards[i];
      if (!guard.is_bounded() || !(guard.mignitude() > 0.0)) {
        unsettled.push_back(number);
        continue;
      }
      const Side side = guard.middle.hi > 0.0 ? Side::above : Side::below;
      changed = changed || sides[to_index(number)] != side;
      sides[to_index(number)] = side;
    }
    if (!changed || !unsettled.empty() || round > count_guards()) return unsettled;
  }
}

FormulaModes::Sides FormulaModes::find_sides(const Interval& time, const std::vector<Interval>& variables) {
  Sides sides(count_guards(), Side::below);
  for (std::size_t round = 0; round <= count_guards(); ++round) {
    const Mode& mode = find(sides);
    const Values values = evaluate(mode, time, variables);
    const Sides before = sides;
    for (std::size_t i = 0; i < mode.guards.size(); ++i)
      sides[to_index(mode.guards[i])] = values.guards[i].middle.hi > 0.0 ? Side::above : Side::below;
    if (sides == before) break;
  }
  return sides;
}

}  // namespace polhode::proof
