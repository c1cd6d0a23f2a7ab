#include "solve/proof/interval_program.hpp"

#include "polhode/math/detail/interval_functions.hpp"
#include "solve/proof/index.hpp"

namespace polhode::proof {

using formula::Node;
using formula::Op;
using math::Interval;

namespace {

Interval compute_sum(const formula::Form& form, const std::vector<Interval>& values) {
  Interval sum(form.constant);
  for (const formula::Term& term : form.terms) sum = sum + Interval(term.factor) * values[to_index(term.node)];
  return sum;
}

bool is_positive(const Interval& x) { return x.mignitude() > 0.0 && x.middle.hi > 0.0; }

}  // namespace

std::vector<Interval> evaluate(const formula::Program& program, const Interval& time,
                               const std::vector<Interval>& states, const std::vector<Interval>& parameters) {
  std::vector<Interval> values(to_index(program.graph.size()));
  const auto compute = [&](int node) -> Interval {
    const Node& n = program.graph[node];
    const auto operand = [&](std::size_t i) { return values[to_index(n.operands[i])]; };
    switch (n.op) {
      case Op::constant: return n.constant;
      case Op::time: return time;
      case Op::state: return states[to_index(n.index)];
      case Op::parameter: return parameters[to_index(n.index)];
      case Op::linear: return compute_sum(program.graph.linear(node), values);
      case Op::multiply: return n.operands[0] == n.operands[1] ? sqr(operand(0)) : operand(0) * operand(1);
      case Op::divide: return operand(0) / operand(1);
      // sqrt() of an interval is of what is not negative in it.
      case Op::root: return operand(0).is_zero() || is_positive(operand(0)) ? sqrt(operand(0)) : Interval::all();
      case Op::exponential: return exp(operand(0));
      case Op::logarithm: return log(operand(0));
      case Op::sine: return sincos(operand(0)).sin;
      case Op::cosine: return sincos(operand(0)).cos;
      case Op::tanh: return tanh(operand(0));
      case Op::angle: {   // it jumps where y = 0 and x < 0
        const bool is_off_cut = operand(0).mignitude() > 0.0 || is_positive(operand(1));
        return is_off_cut ? atan2(operand(0), operand(1)) : Interval::all();
      }
      default: return Interval::all();   // none of these is left in a system
    }
  };
  for (int node = 0; node < program.graph.size(); ++node) values[to_index(node)] = compute(node);
  std::vector<Interval> outputs;
  for (const formula::Form& output : program.outputs) outputs.push_back(compute_sum(output, values));
  return outputs;
}

}  // namespace polhode::proof
