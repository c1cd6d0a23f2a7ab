#include "solve/proof/exact_graph.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "polhode/formula/derivative.hpp"

namespace polhode::proof {

using formula::Expr;
using formula::Form;
using formula::Graph;
using formula::Node;
using formula::Op;
using formula::Program;
using math::Interval;

namespace {

bool is_power_of_two(double x) {
  int exponent;
  return x != 0.0 && std::abs(std::frexp(x, &exponent)) == 0.5 && std::abs(exponent) < 16;
}

std::vector<Form> list_forms(const std::vector<Expr>& list) {
  std::vector<Form> forms;
  for (const Expr& one : list) forms.push_back(one.form());
  return forms;
}

std::vector<Expr> list_expressions(Graph& graph, const std::vector<Form>& forms) {
  std::vector<Expr> list;
  for (const Form& form : forms) list.emplace_back(graph, form);
  return list;
}

/// a^n by squares, n >= 1
Form raise(Graph& graph, const Form& a, long n) {
  if (n == 1) return a;
  const Form half = raise(graph, a, n / 2), square = graph.multiply(half, half);
  return n % 2 == 0 ? square : graph.multiply(square, a);
}

}  // namespace

Form ExactGraph::make(Graph& to, const Interval& value) {
  // Two sets that look the same may stand for two numbers, whose difference is not 0. Exact numbers are shared.
  const auto same = [&](const Interval& other) {
    return other.radius == 0.0 && other.middle.hi == value.middle.hi && other.middle.lo == value.middle.lo;
  };
  auto at = value.radius == 0.0 ? std::find_if(values_.begin(), values_.end(), same) : values_.end();
  if (at == values_.end()) at = values_.insert(at, value);
  return to.parameter(static_cast<int>(at - values_.begin()));
}

Expr ExactGraph::number(const Interval& value) {
  return {graph_, value.is_zero() ? Form() : make(graph_, value)};
}

std::vector<Form> ExactGraph::copy(const Program& law, Graph& to, const std::vector<Form>& states,
                                   const std::vector<Interval>& parameters) {
  formula::Rewriter* own = nullptr;
  const auto scale = [&](const Form& form, double factor) {
    return is_power_of_two(factor) ? form * factor : to.multiply(form, make(to, Interval(factor)));
  };
  const auto sum = [&](const Form& form) {
    Form total = form.constant == 0.0 ? Form() : make(to, Interval(form.constant));
    for (const formula::Term& term : form.terms) total = total + scale((*own)(Form::of(term.node)), term.factor);
    return total;
  };
  const formula::Change change = [&](int node, Graph& graph) -> std::optional<Form> {
    const Node& n = law.graph[node];
    switch (n.op) {
      case Op::constant: return make(graph, Interval(n.constant));
      case Op::parameter: {
        const Interval& value = parameters[static_cast<std::size_t>(n.index)];
        return value.is_zero() ? Form() : make(graph, value);
      }
      case Op::state: return states[static_cast<std::size_t>(n.index)];
      case Op::linear: return sum(law.graph.linear(node));
      case Op::power: {
        const Form a = (*own)(Form::of(n.operands[0]));
        const double size = std::abs(n.constant);
        if (size != std::floor(size) || size > 1e6)
          return graph.exponential(graph.multiply(graph.logarithm(a), make(graph, Interval(n.constant))));
        const Form value = raise(graph, a, static_cast<long>(size));
        return n.constant < 0.0 ? graph.divide(make(graph, Interval(1.0)), value) : value;
      }
      default: return std::nullopt;
    }
  };
  formula::Rewriter rewriter(law.graph, to, change);
  own = &rewriter;
  std::vector<Form> outputs;
  for (const Form& output : law.outputs) outputs.push_back(sum(output));
  return outputs;
}

std::vector<Expr> ExactGraph::add(const Program& law, const std::vector<Expr>& states,
                                  const std::vector<Interval>& parameters) {
  return list_expressions(graph_, copy(formula::expand_rotations(law), graph_, list_forms(states), parameters));
}

std::vector<Expr> ExactGraph::add_potential(const Program& potential, const std::vector<Expr>& states) {
  // The derivative is by a small rotation, so the attitude must be the states' own.
  Program exact;
  std::vector<Form> own;
  for (std::size_t i = 0; i < states.size(); ++i) own.push_back(exact.graph.state(static_cast<int>(i)));
  std::vector<Interval> parameters;
  for (const double value : formula::list_values(potential.parameters)) parameters.emplace_back(value);
  exact.outputs = copy(formula::expand_rotations(potential), exact.graph, own, parameters);
  const Program torque = formula::derive_torque(exact);
  // Its parameters are numbers of this graph already, and its factors exact.
  std::vector<Form> forms = formula::embed(torque, graph_, list_forms(states), nullptr);
  return list_expressions(graph_, forms);
}

}  // namespace polhode::proof
