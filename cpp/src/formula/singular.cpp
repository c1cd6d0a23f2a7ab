#include "polhode/formula/singular.hpp"

#include <cmath>

#include "polhode/formula/parser.hpp"

namespace polhode::formula {
namespace {

std::size_t place(int i) { return static_cast<std::size_t>(i); }

/// An operand as text.
std::string show(const Program& program, int node) {
  Program one{program.graph, program.parameters, program.states, {Form::of(node), Form(), Form()}};
  one.states.clear();
  const Text text = print(one);
  if (!text.let.empty() || text.torque.size() > 100) return "an expression";
  return text.torque.substr(1, text.torque.find(", 0") - 1);
}

}  // namespace

std::string find_singular(const Program& program, double t, const double* y, double near) {
  Evaluator evaluator(program);
  std::vector<double> outputs(program.outputs.size());
  evaluator(t, y, nullptr, outputs.data());
  const Graph& graph = program.graph;
  // Of switches only the branches that are taken.
  std::vector<bool> live(place(graph.size()));
  const auto mark = [&](const Form& form) {
    for (const Term& term : form.terms) live[place(term.node)] = true;
  };
  for (const Form& output : program.outputs) mark(output);
  for (int i = graph.size() - 1; i >= 0; --i) {
    if (!live[place(i)]) continue;
    const Node& n = graph[i];
    if (n.op == Op::linear) mark(graph.linear(i));
    const bool skips_first = n.op == Op::choose && !(evaluator.value(n.operands[0]) > 0.0);
    for (std::size_t k = 0; k < 3; ++k)
      if (n.operands[k] >= 0 && !(n.op == Op::choose && k == (skips_first ? 1U : 2U))) live[place(n.operands[k])] = true;
    const bool has_b = n.op == Op::divide || n.op == Op::angle;
    const double a = n.operands[0] >= 0 ? evaluator.value(n.operands[0]) : 1.0;
    const double b = has_b ? evaluator.value(n.operands[1]) : 0.0;
    const auto is_zero = [&](double x) { return !(std::abs(x) > near); };
    switch (n.op) {
      case Op::divide:
        if (is_zero(b)) return "the division by " + show(program, n.operands[1]);
        break;
      case Op::root:
        if (is_zero(a) || a < 0.0) return "the root of " + show(program, n.operands[0]);
        break;
      case Op::logarithm:
        if (is_zero(a) || a < 0.0) return "the logarithm of " + show(program, n.operands[0]);
        break;
      case Op::power:
        if (is_zero(a) || a < 0.0) return "a power of " + show(program, n.operands[0]);
        break;
      case Op::angle:
        if (is_zero(a) && is_zero(b)) return "atan2(0, 0) of " + show(program, n.operands[0]);
        break;
      default: break;
    }
  }
  return "";
}

}  // namespace polhode::formula
