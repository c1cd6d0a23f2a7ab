#include "formula/polynomial.hpp"

#include <algorithm>
#include <cmath>

#include "formula/carry.hpp"

namespace polhode::formula {
namespace {

constexpr std::size_t x_place = 3, w_place = 6;

bool is_within_limits(const Monomial& m) {
  return m[0] + m[1] + m[2] <= Polynomial::most_degree && m[3] + m[4] + m[5] + m[6] <= Polynomial::most_degree &&
         m[7] + m[8] <= Polynomial::most_degree;
}

}  // namespace

Polynomial Polynomial::variable(std::size_t place) {
  Polynomial p;
  Monomial m{};
  m[place] = 1;
  p.add(m, {1.0, 1.0});
  return p;
}

void Polynomial::add(const Monomial& monomial, const Coefficient& coefficient) {
  Coefficient& sum = terms_[monomial];
  sum.value = sum.value + coefficient.value;
  sum.size += coefficient.size;
}

void Polynomial::add_reduced(Monomial monomial, const Coefficient& coefficient) {
  const Coefficient minus{-coefficient.value, coefficient.size};
  if (monomial[w_place] >= 2) {
    // w^2 = 1 - x^2 - y^2 - z^2
    monomial[w_place] = static_cast<std::uint8_t>(monomial[w_place] - 2);
    add_reduced(monomial, coefficient);
    for (std::size_t i = x_place; i < w_place; ++i) {
      Monomial other = monomial;
      other[i] = static_cast<std::uint8_t>(other[i] + 2);
      add_reduced(other, minus);
    }
  } else if (monomial[sine_place] >= 2) {
    monomial[sine_place] = static_cast<std::uint8_t>(monomial[sine_place] - 2);
    add_reduced(monomial, coefficient);
    monomial[cosine_place] = static_cast<std::uint8_t>(monomial[cosine_place] + 2);
    add_reduced(monomial, minus);
  } else {
    add(monomial, coefficient);
  }
}

void Polynomial::add(const Polynomial& other, double factor) {
  for (const auto& [monomial, c] : other.terms_)
    add(monomial, {c.value * math::DD(factor), c.size * std::abs(factor)});
}

std::optional<Polynomial> Polynomial::multiply(const Polynomial& a, const Polynomial& b) {
  Polynomial product;
  for (const auto& [left, c] : a.terms_) {
    for (const auto& [right, d] : b.terms_) {
      Monomial m;
      for (std::size_t i = 0; i < m.size(); ++i) m[i] = static_cast<std::uint8_t>(left[i] + right[i]);
      if (!is_within_limits(m)) return std::nullopt;
      product.add_reduced(m, {c.value * d.value, c.size * d.size});
      if (product.terms_.size() > most_terms) return std::nullopt;
    }
  }
  return product;
}

bool Polynomial::is_zero() const {
  return std::all_of(terms_.begin(), terms_.end(), [](const auto& term) { return term.second.is_zero(); });
}

double Polynomial::coefficient(const Monomial& monomial) const {
  const auto found = terms_.find(monomial);
  return found == terms_.end() || found->second.is_zero() ? 0.0 : found->second.value.hi;
}

std::optional<TorquePolynomials> expand_torque(const Program& torque) {
  const Program program = expand_rotations(torque);
  const Graph& graph = program.graph;
  const std::vector<Form> wanted(program.outputs.begin(), program.outputs.begin() + 3);
  const auto find_node_wave = [&](int node) -> std::optional<Wave> {
    const Node& n = graph[node];
    if (n.op != Op::sine && n.op != Op::cosine) return std::nullopt;
    return find_wave(graph, n.operands[0]);
  };
  const std::vector<bool> live = find_live(graph, wanted, [&](int node) { return find_node_wave(node).has_value(); });
  TorquePolynomials found;
  std::vector<Polynomial> of(live.size());
  const auto sum = [&](const Form& form) {
    Polynomial p(form.constant);
    for (const Term& term : form.terms) p.add(of[static_cast<std::size_t>(term.node)], term.factor);
    return p;
  };
  for (int i = 0; i < graph.size(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (!live[at]) continue;
    const Node& n = graph[i];
    if (n.op == Op::constant) {
      of[at] = Polynomial(n.constant);
    } else if (n.op == Op::state && n.index < first_extra) {
      of[at] = Polynomial::variable(static_cast<std::size_t>(n.index));
    } else if (n.op == Op::linear) {
      of[at] = sum(graph.linear(i));
    } else if (n.op == Op::multiply) {
      const auto product = Polynomial::multiply(of[static_cast<std::size_t>(n.operands[0])],
                                                of[static_cast<std::size_t>(n.operands[1])]);
      if (!product) return std::nullopt;
      of[at] = *product;
    } else if (const std::optional<Wave> wave = find_node_wave(i)) {
      if (found.wave && (found.wave->phase != wave->phase || found.wave->rate != wave->rate)) return std::nullopt;
      found.wave = wave;
      of[at] = Polynomial::variable(n.op == Op::cosine ? cosine_place : sine_place);
    } else {
      return std::nullopt;
    }
  }
  for (std::size_t i = 0; i < 3; ++i) found.tau[i] = sum(wanted[i]);
  return found;
}

}  // namespace polhode::formula
