#include "polhode/formula/sides.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "polhode/core/error.hpp"
#include "polhode/formula/derivative.hpp"
#include "polhode/formula/expression.hpp"
#include "polhode/formula/modes.hpp"

namespace polhode::formula {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Form guard_of(const Graph& graph, int node) {
  return graph[node].op == Op::linear ? graph.linear(node) : Form::of(node);
}

/// The factor from one form to another of the same surface, up to rounding; 0 for another surface.
double find_factor(const Form& from, const Form& to) {
  constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();
  if (from.terms.size() != to.terms.size()) return 0.0;
  const double factor = to.terms[0].factor / from.terms[0].factor;
  const auto fits = [&](double a, double b) { return std::abs(b - factor * a) <= rounding * std::abs(b); };
  for (std::size_t i = 0; i < from.terms.size(); ++i)
    if (from.terms[i].node != to.terms[i].node || !fits(from.terms[i].factor, to.terms[i].factor)) return 0.0;
  return fits(from.constant, to.constant) ? factor : 0.0;
}

/// Solves A x = b by Gaussian elimination without a choice of pivots: inertia makes A positive definite.
std::vector<Expr> solve(std::vector<std::vector<Expr>> A, std::vector<Expr> b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    if (A[k][k].form().is_zero())
      throw InvalidInput("friction", "a rate that its own torque changes", "one that it does not");
    for (std::size_t i = k + 1; i < n; ++i) {
      const Expr part = A[i][k] / A[k][k];
      for (std::size_t j = k; j < n; ++j) A[i][j] = A[i][j] - part * A[k][j];
      b[i] = b[i] - part * b[k];
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t j = k + 1; j < n; ++j) b[k] = b[k] - A[k][j] * b[j];
    b[k] = b[k] / A[k][k];
  }
  return b;
}

/// Whether a switch takes its first branch.
bool takes_first(Side side, const Guards::Place& guard) { return side == (guard.negated ? Side::below : Side::above); }

/// A program with all switches replaced; friction that holds has the share parameter(0), parameter(1), ...
Program replace_switches(const Program& whole, const Guards& guards, const std::vector<Side>& sides,
                         const std::vector<int>& held) {
  Program made{{}, {}, whole.states, {}};
  Rewriter* own = nullptr;
  Rewriter rewriter(whole.graph, made.graph, [&](int node, Graph& to) -> std::optional<Form> {
    const Node& n = whole.graph[node];
    if (n.op != Op::choose) return std::nullopt;
    const Guards::Place guard = guards.find(whole.graph, n.operands[0]);
    const Side side = sides[guard.number];
    if (side == Side::held && n.index == 1) {
      const auto place = std::find(held.begin(), held.end(), static_cast<int>(guard.number));
      const Form share = to.parameter(static_cast<int>(place - held.begin()));
      return guard.negated ? -share : share;
    }
    return (*own)(Form::of(n.operands[takes_first(side, guard) ? 1 : 2]));
  });
  own = &rewriter;
  for (const Form& output : whole.outputs) made.outputs.push_back(rewriter(output));
  for (const Form& rate : whole.rates) made.rates.push_back(rewriter(rate));
  return made;
}

/// The shares that keep the last outputs, the held rates, constant: of d/dt rate = b + A s, A s = -b. A rate may depend
/// on time, as on a belt that speeds up.
Program hold(const Program& system, std::size_t states, std::size_t first, std::size_t count) {
  std::vector<Variable> variables;
  for (std::size_t i = 0; i < states; ++i) variables.push_back({Variable::Kind::state, static_cast<int>(i)});
  variables.push_back({Variable::Kind::time, 0});
  Program rates{system.graph, {}, system.states, {}};
  for (std::size_t i = 0; i < states; ++i) rates.outputs.push_back(system.outputs[i]);
  for (std::size_t i = 0; i < count; ++i) rates.outputs.push_back(system.outputs[first + i]);
  const std::size_t outputs = rates.outputs.size();
  Program d = differentiate(rates, variables);
  Program change{d.graph, {}, system.states, {}};
  for (std::size_t i = 0; i < count; ++i) {
    Form sum = d.outputs[outputs * (states + 1) + states + i];
    for (std::size_t m = 0; m < states; ++m)
      sum = sum + change.graph.multiply(d.outputs[outputs * (m + 1) + states + i], d.outputs[m]);
    change.outputs.push_back(sum);
  }
  std::vector<Variable> shares;
  for (std::size_t i = 0; i < count; ++i) shares.push_back({Variable::Kind::parameter, static_cast<int>(i)});
  const Program slopes = differentiate(change, shares);

  Program made{{}, {}, system.states, {}};
  Rewriter at_zero(slopes.graph, made.graph, [&](int node, Graph&) -> std::optional<Form> {
    return slopes.graph[node].op == Op::parameter ? std::optional(Form()) : std::nullopt;
  });
  std::vector<std::vector<Expr>> A(count, std::vector<Expr>(count));
  std::vector<Expr> b(count);
  for (std::size_t i = 0; i < count; ++i) {
    b[i] = Expr(made.graph, -at_zero(slopes.outputs[i]));
    for (std::size_t j = 0; j < count; ++j) A[i][j] = Expr(made.graph, at_zero(slopes.outputs[count * (j + 1) + i]));
  }
  const std::vector<Expr> shares_now = solve(std::move(A), std::move(b));
  Rewriter with_shares(system.graph, made.graph, [&](int node, Graph&) -> std::optional<Form> {
    const Node& n = system.graph[node];
    if (n.op != Op::parameter) return std::nullopt;
    return shares_now[at(n.index)].form();
  });
  for (const Form& output : system.outputs) made.outputs.push_back(with_shares(output));
  for (const Form& rate : system.rates) made.rates.push_back(with_shares(rate));
  for (std::size_t i = 0; i < count; ++i) {   // in the place of the held rates
    made.outputs[first + 2 * i] = Form(1.0) - shares_now[i].form();
    made.outputs[first + 2 * i + 1] = Form(1.0) + shares_now[i].form();
  }
  return made;
}

}  // namespace

Guards::Place Guards::find(const Graph& graph, int node) const {
  const Form guard = guard_of(graph, node);
  for (std::size_t i = 0; i < forms.size(); ++i)
    if (const double factor = find_factor(forms[i], guard); factor != 0.0) return {i, factor < 0.0};
  return {forms.size(), false};
}

Guards list_sided_guards(const Program& program) {
  Guards guards;
  for (const int node : list_switches(program)) {
    const Node& n = program.graph[node];
    const std::size_t number = guards.find(program.graph, n.operands[0]).number;
    if (number == guards.forms.size()) {
      guards.forms.push_back(guard_of(program.graph, n.operands[0]));
      guards.holds.push_back(false);
      guards.nodes.push_back(n.operands[0]);
    }
    if (n.index == 1) guards.holds[number] = true;
  }
  return guards;
}

ModeProgram make_mode(const Program& system, const std::vector<Side>& sides, std::size_t further) {
  const Guards guards = list_sided_guards(system);
  // From the outputs down, the guards of switches that the branches taken need.
  const Graph& graph = system.graph;
  std::vector<bool> live(at(graph.size()));
  std::vector<bool> needed(guards.forms.size());
  const auto mark = [&](const Form& form) {
    for (const Term& term : form.terms) live[at(term.node)] = true;
  };
  for (const Form& output : system.outputs) mark(output);
  for (int i = graph.size() - 1; i >= 0; --i) {
    if (!live[at(i)]) continue;
    const Node& n = graph[i];
    if (n.op == Op::linear) mark(graph.linear(i));
    if (n.op != Op::choose) {
      for (const int operand : n.operands)
        if (operand >= 0) live[at(operand)] = true;
      continue;
    }
    const Guards::Place guard = guards.find(graph, n.operands[0]);
    needed[guard.number] = true;
    live[at(n.operands[0])] = true;
    if (const Side side = sides[guard.number]; side != Side::held || n.index == 0)
      live[at(n.operands[takes_first(side, guard) ? 1 : 2])] = true;
  }
  ModeProgram made;
  std::vector<int> held;
  Program whole = system;
  for (std::size_t i = 0; i < needed.size(); ++i) {
    const int number = static_cast<int>(i);
    if (!needed[i]) continue;
    if (sides[i] == Side::held) {
      held.push_back(number);
    } else {
      whole.outputs.push_back(guards.forms[i]);
      made.guards.push_back({number});
    }
  }
  const std::size_t first = whole.outputs.size();
  for (const int number : held) {
    whole.outputs.push_back(guards.forms[at(number)]);
    made.guards.push_back({number, Side::above});
    made.guards.push_back({number, Side::below});
  }
  Program smooth = replace_switches(whole, guards, sides, held);
  if (!held.empty()) {
    smooth.outputs.resize(first + 2 * held.size());   // the limits take more places than the rates
    smooth = hold(smooth, system.outputs.size() - further, first, held.size());
  }
  made.program = rewrite(smooth);
  return made;
}

}  // namespace polhode::formula
