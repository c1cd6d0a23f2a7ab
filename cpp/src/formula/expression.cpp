#include "polhode/formula/expression.hpp"

#include <utility>

#include "polhode/core/error.hpp"

namespace polhode::formula {
namespace {

Graph* graph_of(const Expr& a, const Expr& b) {
  if (a.graph() != nullptr && b.graph() != nullptr && a.graph() != b.graph()) {
    throw InvalidInput("formula", "expressions of one formula", "expressions of two");
  }
  return a.graph() != nullptr ? a.graph() : b.graph();
}

Expr make(Graph* graph, Form form) { return graph != nullptr ? Expr(*graph, std::move(form)) : Expr(form.constant); }

template <class Function>
Expr apply(const Expr& a, Function function) {
  if (a.graph() != nullptr) return Expr(*a.graph(), function(*a.graph()));
  Graph graph;
  return Expr(function(graph).constant);
}

}  // namespace

Expr operator+(const Expr& a, const Expr& b) { return make(graph_of(a, b), a.form() + b.form()); }
Expr operator-(const Expr& a, const Expr& b) { return make(graph_of(a, b), a.form() - b.form()); }
Expr operator-(const Expr& a) { return make(a.graph(), -a.form()); }

Expr operator*(const Expr& a, const Expr& b) {
  Graph* graph = graph_of(a, b);
  if (graph == nullptr) return Expr(a.form().constant * b.form().constant);
  return Expr(*graph, graph->multiply(a.form(), b.form()));
}

Expr operator/(const Expr& a, const Expr& b) {
  Graph* graph = graph_of(a, b);
  return graph != nullptr ? Expr(*graph, graph->divide(a.form(), b.form()))
                          : apply(a, [&](Graph& g) { return g.divide(a.form(), b.form()); });
}

Condition operator>(const Expr& a, const Expr& b) { return {a - b, false}; }
Condition operator<(const Expr& a, const Expr& b) { return {b - a, false}; }
Condition operator<=(const Expr& a, const Expr& b) { return {a - b, true}; }
Condition operator>=(const Expr& a, const Expr& b) { return {b - a, true}; }

Expr sqrt(const Expr& a) {
  return apply(a, [&](Graph& g) { return g.root(a.form()); });
}
Expr pow(const Expr& a, double exponent) {
  return apply(a, [&](Graph& g) { return g.power(a.form(), exponent); });
}
Expr exp(const Expr& a) {
  return apply(a, [&](Graph& g) { return g.exponential(a.form()); });
}
Expr log(const Expr& a) {
  return apply(a, [&](Graph& g) { return g.logarithm(a.form()); });
}
Expr sin(const Expr& a) {
  return apply(a, [&](Graph& g) { return g.sine(a.form()); });
}
Expr cos(const Expr& a) {
  return apply(a, [&](Graph& g) { return g.cosine(a.form()); });
}
Expr tan(const Expr& a) { return sin(a) / cos(a); }
Expr tanh(const Expr& a) {
  return apply(a, [&](Graph& g) { return g.tanh(a.form()); });
}

Expr atan2(const Expr& y, const Expr& x) {
  Graph* graph = graph_of(y, x);
  return graph != nullptr ? Expr(*graph, graph->angle(y.form(), x.form()))
                          : Expr(math::atan2(y.form().constant, x.form().constant));
}

Expr where(const Condition& condition, const Expr& yes, const Expr& no) {
  const Expr &first = condition.negated ? no : yes, &second = condition.negated ? yes : no;
  Graph* graph = graph_of(first, second);
  if (graph == nullptr) graph = condition.guard.graph();
  if (graph == nullptr) return condition.guard.form().constant > 0.0 ? first : second;
  return Expr(*graph, graph->choose(condition.guard.form(), first.form(), second.form()));
}

Expr friction(const Expr& load, const Expr& rate) {
  return -load * apply(rate, [&](Graph& g) { return g.slip(rate.form()); });
}

Vec<Expr, 3> to_body(const Vec<Expr, 4>& attitude, const Vec<Expr, 3>& v) {
  Graph* graph = attitude[0].graph();
  for (std::size_t i = 0; i < 4; ++i) {
    if (graph == nullptr || attitude[i].form() != graph->state(first_attitude + static_cast<int>(i)))
      return rotate_to_body(attitude, v);
  }
  const std::array<Form, 3> seen = graph->to_body({v[0].form(), v[1].form(), v[2].form()});
  return {{Expr(*graph, seen[0]), Expr(*graph, seen[1]), Expr(*graph, seen[2])}};
}

Seen<Expr> see(const Ephemeris& ephemeris, const Expr& t) {
  if (t.graph() == nullptr || !(t.form() == t.graph()->time()))
    throw InvalidInput("orbit.at", "called with the time t itself", "another expression",
                       "an orbit at a shifted time is an Orbit with another t0");
  const auto number = [&](int i) { return Expr(*t.graph(), t.graph()->ephemeris(ephemeris, i)); };
  return {{{number(0), number(1), number(2)}}, {{number(3), number(4), number(5)}}, number(6), number(7)};
}

}  // namespace polhode::formula
