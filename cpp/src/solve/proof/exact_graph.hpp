#pragma once

#include <vector>

#include "polhode/formula/expression.hpp"
#include "polhode/formula/program.hpp"
#include "polhode/math/detail/interval.hpp"

namespace polhode::proof {

/// A graph in which nothing is rounded: each number is a parameter whose value is a set.
///
/// So the factors of forms are powers of two and small whole numbers, which sums, products and derivatives keep exact,
/// and no function of a number is folded. A power with another exponent than a whole number is exp(c log a).
class ExactGraph {
 public:
  formula::Graph& graph() { return graph_; }
  const std::vector<math::Interval>& values() const { return values_; }   ///< of the parameters

  /// A number; the form 0 for an exact 0.
  formula::Expr number(const math::Interval& value);

  /// The outputs of a program of a law.
  /// @param states  as embed() takes them, with factors that are powers of two
  /// @param parameters  the values of its parameters
  std::vector<formula::Expr> add(const formula::Program& law, const std::vector<formula::Expr>& states,
                                 const std::vector<math::Interval>& parameters);

  /// The torque -dV(q exp(e_i a / 2))/da of a potential.
  std::vector<formula::Expr> add_potential(const formula::Program& potential,
                                           const std::vector<formula::Expr>& states);

  /// The graph itself, which is then empty.
  formula::Graph take() { return std::move(graph_); }

 private:
  std::vector<formula::Form> copy(const formula::Program& law, formula::Graph& to,
                                  const std::vector<formula::Form>& states,
                                  const std::vector<math::Interval>& parameters);
  formula::Form make(formula::Graph& to, const math::Interval& value);

  formula::Graph graph_;
  std::vector<math::Interval> values_;
};

}  // namespace polhode::proof
