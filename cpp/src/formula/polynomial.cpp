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

TorquePolynomials expand_torque(const Program& torque) {
  TorquePolynomials found;
  found.rest = expand_rotations(torque);
  const Graph& graph = found.rest.graph;
  const auto find_node_wave = [&](int node) -> std::optional<Wave> {
    const Node& n = graph[node];
    if (n.op != Op::sine && n.op != Op::cosine) return std::nullopt;
    return find_wave(graph, n.operands[0]);
  };
  std::vector<std::optional<Polynomial>> of(static_cast<std::size_t>(graph.size()));
  const auto at = [&](int node) -> std::optional<Polynomial>& { return of[static_cast<std::size_t>(node)]; };
  const auto expand = [&](int i) -> std::optional<Polynomial> {
    const Node& n = graph[i];
    if (n.op == Op::constant) return Polynomial(n.constant);
    if (n.op == Op::state && n.index < first_extra) return Polynomial::variable(static_cast<std::size_t>(n.index));
    if (n.op == Op::linear) {
      Polynomial sum(graph.linear(i).constant);
      for (const Term& term : graph.linear(i).terms) {
        if (!at(term.node)) return std::nullopt;
        sum.add(*at(term.node), term.factor);
      }
      return sum;
    }
    if (n.op == Op::multiply) {
      const std::optional<Polynomial>&a = at(n.operands[0]), &b = at(n.operands[1]);
      return a && b ? Polynomial::multiply(*a, *b) : std::nullopt;
    }
    const std::optional<Wave> wave = find_node_wave(i);
    if (!wave || (found.wave && (found.wave->phase != wave->phase || found.wave->rate != wave->rate)))
      return std::nullopt;
    found.wave = wave;
    return Polynomial::variable(n.op == Op::cosine ? cosine_place : sine_place);
  };
  for (int i = 0; i < graph.size(); ++i) at(i) = expand(i);
  for (std::size_t i = 0; i < 3; ++i) {
    Form& output = found.rest.outputs[i];
    found.tau[i] = Polynomial(output.constant);
    output.constant = 0.0;
    std::erase_if(output.terms, [&](const Term& term) {
      if (!at(term.node)) return false;
      found.tau[i].add(*at(term.node), term.factor);
      return true;
    });
  }
  return found;
}

Program add_polynomials(Program torque, const std::array<Polynomial, 3>& tau, const std::optional<Wave>& wave) {
  Graph& graph = torque.graph;
  for (std::size_t i = 0; i < 3; ++i) {
    for (const auto& [monomial, coefficient] : tau[i].terms()) {
      if (coefficient.is_zero()) continue;
      Form product(coefficient.value.hi);
      for (std::size_t place = 0; place < monomial.size(); ++place) {
        for (int k = 0; k < monomial[place]; ++k) {
          if (place < cosine_place) {
            product = graph.multiply(product, graph.state(static_cast<int>(place)));
          } else {
            const Form angle = graph.time() * wave->rate + Form(wave->phase);
            product = graph.multiply(product, place == cosine_place ? graph.cosine(angle) : graph.sine(angle));
          }
        }
      }
      torque.outputs[i] = torque.outputs[i] + product;
    }
  }
  return rewrite(torque);
}

}  // namespace polhode::formula
