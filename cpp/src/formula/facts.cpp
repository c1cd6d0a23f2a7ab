#include "polhode/formula/facts.hpp"

#include <algorithm>

namespace polhode::formula {
namespace {

/// Degrees of nodes as polynomials in some of the states.
class Degrees {
 public:
  Degrees(const Program& program, const std::vector<bool>& live, int end)
      : graph_(program.graph), end_(end), degrees_(live.size(), 0) {
    for (std::size_t i = 0; i < live.size(); ++i)
      if (live[i]) degrees_[i] = compute(static_cast<int>(i));
  }

  int of(const Form& form) const {
    int highest = 0;
    for (const Term& term : form.terms) {
      if (at(term.node) < 0) return -1;
      highest = std::max(highest, at(term.node));
    }
    return highest;
  }

 private:
  int at(int node) const { return degrees_[static_cast<std::size_t>(node)]; }

  int compute(int node) const {
    const Node& n = graph_[node];
    if (n.op == Op::state) return n.index < end_ ? 1 : 0;
    if (n.op == Op::linear) return of(graph_.linear(node));
    int sum = 0, highest = 0;
    for (const int operand : n.operands) {
      if (operand < 0) continue;
      if (at(operand) < 0) return -1;
      sum += at(operand), highest = std::max(highest, at(operand));
    }
    if (n.op == Op::multiply) return sum;
    if (n.op == Op::divide) return at(n.operands[1]) == 0 ? at(n.operands[0]) : -1;
    if (n.op == Op::to_body) return highest + (end_ > first_attitude ? 2 : 0);
    return highest == 0 ? 0 : -1;
  }

  const Graph& graph_;
  int end_;
  std::vector<int> degrees_;
};

}  // namespace

Facts find_facts(const Program& torque) {
  Facts facts;
  const std::vector<bool> live = find_live(torque.graph, torque.outputs);
  for (int i = 0; i < torque.graph.size(); ++i) {
    if (!live[static_cast<std::size_t>(i)]) continue;
    const Node& n = torque.graph[i];
    facts.uses_time |= n.op == Op::time || n.op == Op::ephemeris;
    facts.has_switches |= n.op == Op::choose;
    if (n.op != Op::state) continue;
    facts.uses_rates |= n.index < first_attitude;
    facts.uses_attitude |= n.index >= first_attitude && n.index < first_extra;
    facts.uses_states |= n.index >= first_extra;
  }
  const Degrees all(torque, live, Graph::most_nodes), rates(torque, live, first_attitude);
  for (const Form& output : torque.outputs) {
    const int degree = all.of(output), rate_degree = rates.of(output);
    facts.degree = degree < 0 || facts.degree < 0 ? -1 : std::max(facts.degree, degree);
    facts.rate_degree = rate_degree < 0 || facts.rate_degree < 0 ? -1 : std::max(facts.rate_degree, rate_degree);
  }
  return facts;
}

}  // namespace polhode::formula
