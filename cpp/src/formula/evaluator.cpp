#include <array>
#include <cmath>

#include "polhode/formula/detail/functions.hpp"
#include "polhode/formula/expression.hpp"
#include "polhode/formula/program.hpp"

namespace polhode::formula {

Evaluator::Evaluator(const Program& program)
    : program_(program), values_(static_cast<std::size_t>(program.graph.size())) {
  const std::vector<bool> live = find_live(program.graph, program.outputs);
  for (int i = 0; i < program.graph.size(); ++i)
    if (live[static_cast<std::size_t>(i)]) live_.push_back(i);
}

void Evaluator::evaluate(double t, const double* y, const double* parameters, double* values, double* outputs) const {
  // Each ephemeris is evaluated once, at the first of its numbers.
  std::array<double, Ephemeris::size * Graph::most_ephemerides> known;
  unsigned seen = 0;
  for (const int node : live_) {
    const Node& n = program_.graph[node];
    if (n.op != Op::ephemeris) {
      values[node] = compute(node, t, y, parameters, values);
      continue;
    }
    const int which = n.index / Ephemeris::size;
    if ((seen >> which & 1) == 0)
      program_.graph.ephemeris_of(n).path()->evaluate(math::DD(t), known.data() + Ephemeris::size * which);
    seen |= 1u << which;
    values[node] = known[static_cast<std::size_t>(n.index)];
  }
  for (const Form& output : program_.outputs) *outputs++ = compute(output, values);
}

double Evaluator::compute(const Form& form, const double* values) {
  double sum = form.constant;
  for (const Term& term : form.terms) sum += term.factor * values[term.node];
  return sum;
}

double Evaluator::compute(int node, double t, const double* y, const double* parameters, const double* values) const {
  const Node& n = program_.graph[node];
  const auto operand = [&](std::size_t i) { return values[n.operands[i]]; };
  switch (n.op) {
    case Op::constant: return n.constant;
    case Op::time: return t;
    case Op::state: return y[n.index];
    case Op::parameter: return parameters[n.index];
    case Op::ephemeris: break;   // not here
    case Op::linear: return compute(program_.graph.linear(node), values);
    case Op::multiply: return operand(0) * operand(1);
    case Op::divide: return operand(0) / operand(1);
    case Op::root: return std::sqrt(operand(0));
    case Op::power: return math::pow(operand(0), n.constant);
    case Op::exponential: return compute_exp(operand(0));
    case Op::logarithm: return math::log(operand(0));
    case Op::sine: return math::sin(operand(0));
    case Op::cosine: return math::cos(operand(0));
    case Op::tanh: return compute_tanh(operand(0)).value;
    case Op::angle: return math::atan2(operand(0), operand(1));
    case Op::choose: return operand(0) > 0.0 ? operand(1) : operand(2);
    case Op::to_body: {
      const double* q = y + first_attitude;
      const Vec<double, 4> attitude{{q[0], q[1], q[2], q[3]}};
      const Vec<double, 3> v{{operand(0), operand(1), operand(2)}};
      return rotate_to_body(attitude, v)[static_cast<std::size_t>(n.index)];
    }
  }
  return 0.0;
}

}  // namespace polhode::formula
