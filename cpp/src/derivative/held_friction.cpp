#include "derivative/held_friction.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "polhode/core/error.hpp"
#include "polhode/formula/modes.hpp"

namespace polhode {

using formula::Form;
using formula::Graph;
using formula::Program;

HeldShares replace_held(Program& plain, Graph& whole, const formula::Guards& guards, const std::vector<Form>& body,
                        const std::vector<formula::Side>& sides) {
  HeldShares found;
  if (std::find(sides.begin(), sides.end(), formula::Side::held) == sides.end()) return found;
  std::map<int, Form> replaced;
  for (const int node : formula::list_switches(plain)) {
    if (plain.graph[node].index != 1) continue;
    const Form form = formula::embed({plain.graph, {}, {}, {Form::of(node)}}, whole, body, nullptr)[0];
    const bool is_switch = form.terms.size() == 1 && whole[form.terms[0].node].op == formula::Op::choose;
    const formula::Guards::Place guard =
        is_switch ? guards.find(whole, whole[form.terms[0].node].operands[0]) : formula::Guards::Place{sides.size(), false};
    if (guard.number == sides.size())
      throw InvalidInput("sensitivity", "left out for this formula", "switches that cannot be told apart");
    if (sides[guard.number] != formula::Side::held) continue;
    const double sign = guard.negated ? -1.0 : 1.0;
    const auto own = std::find(found.guards.begin(), found.guards.end(), guard.number);
    const int number = static_cast<int>(body.size()) + static_cast<int>(own - found.guards.begin());
    if (own == found.guards.end()) {
      found.guards.push_back(guard.number);
      found.forms.push_back(Form::of(form.terms[0].node) * sign);
    }
    replaced[node] = plain.graph.state(number) * (sign * form.terms[0].factor);
  }
  Program made;
  formula::Rewriter rewriter(plain.graph, made.graph, [&](int node, Graph& to) -> std::optional<Form> {
    const auto one = replaced.find(node);
    if (one == replaced.end()) return std::nullopt;
    const formula::Term& share = one->second.terms[0];
    return to.state(plain.graph[share.node].index) * share.factor;
  });
  for (const Form& output : plain.outputs) made.outputs.push_back(rewriter(output));
  plain = std::move(made);
  return found;
}

Program change_held(const Program& slopes, const std::vector<std::size_t>& guards,
                    const std::vector<formula::Variable>& variables) {
  const std::size_t rows = slopes.outputs.size() / (1 + variables.size());
  Program change{slopes.graph, {}, {}, {}};
  const auto slope = [&](std::size_t row, std::size_t by) { return slopes.outputs[rows * (1 + by) + row]; };
  for (const std::size_t row : guards) {
    Form sum = slope(row, variables.size() - 1);
    for (std::size_t i = 0; i + 1 + guards.size() < variables.size(); ++i) {
      const Form moves = i < 3   ? slopes.outputs[i]
                         : i < 6 ? change.graph.state(formula::first_rate + static_cast<int>(i) - 3)
                                 : slopes.outputs[i - 3];
      const Form by = slope(row, i);
      if (!by.is_zero() && !moves.is_zero()) sum = sum + change.graph.multiply(by, moves);
    }
    change.outputs.push_back(sum);
  }
  return change;
}

HeldFriction::HeldFriction(formula::Graph& graph, std::vector<Share> shares)
    : graph_(graph), shares_(std::move(shares)) {
  for (std::size_t k = 0; k < shares_.size(); ++k) {
    const Share& own = shares_[k];
    const Form pivot = dot(own.slope, own.effect);
    if (pivot.is_zero()) throw InvalidInput("friction", "a rate that its own torque changes", "one that it does not");
    for (std::size_t l = k + 1; l < shares_.size(); ++l) {
      Share& other = shares_[l];
      const Form part = divide(dot(other.slope, own.effect), pivot), taken = divide(dot(own.slope, other.effect), pivot);
      for (std::size_t i = 0; i < other.effect.size(); ++i)
        other.effect[i] = other.effect[i] - multiply(taken, own.effect[i]);
      for (std::size_t i = 0; i < other.change.size(); ++i)
        other.change[i] = other.change[i] - multiply(part, own.change[i]);
    }
    pivots_.push_back(pivot);
  }
}

void HeldFriction::add(std::vector<std::vector<Form>>& slopes) const {
  for (std::size_t k = 0; k < shares_.size(); ++k) {
    const std::vector<Form> response = find_response(k);
    for (std::size_t i = 0; i < slopes.size(); ++i)
      for (std::size_t from = 0; from < slopes[i].size(); ++from)
        slopes[i][from] = slopes[i][from] - multiply(response[i], shares_[k].change[from]);
  }
}

void HeldFriction::project(std::vector<Form>& force) const {
  for (std::size_t k = 0; k < shares_.size(); ++k) {
    const Form change = dot(shares_[k].slope, force);
    const std::vector<Form> response = find_response(k);
    for (std::size_t i = 0; i < force.size(); ++i) force[i] = force[i] - multiply(response[i], change);
  }
}

std::vector<Form> HeldFriction::find_response(std::size_t share) const {
  std::vector<Form> response;
  for (const Form& effect : shares_[share].effect) response.push_back(divide(effect, pivots_[share]));
  return response;
}

Form HeldFriction::dot(const std::vector<Form>& a, const std::vector<Form>& b) const {
  Form sum;
  for (std::size_t i = 0; i < a.size(); ++i) sum = sum + multiply(a[i], b[i]);
  return sum;
}

Form HeldFriction::multiply(const Form& a, const Form& b) const {
  return a.is_zero() || b.is_zero() ? Form() : graph_.multiply(a, b);
}

Form HeldFriction::divide(const Form& a, const Form& b) const {
  return a.is_zero() ? Form() : graph_.divide(a, b);
}

}  // namespace polhode
