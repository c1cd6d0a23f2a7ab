#pragma once

#include <vector>

#include "polhode/math/detail/interval.hpp"
#include "solve/proof/index.hpp"

// Equations y' = c + L y + Q(y, y) with constants that are intervals.
namespace polhode::proof {

using math::Interval;

/// A term of one component of y': a constant times 1, a variable, or a product of two variables.
struct Term {
  enum class Kind { constant, variable, product };
  int row;
  Kind kind;
  int source;            ///< which variable or product
  Interval factor;
};

struct Product {
  int a, b;              ///< the variables
};

class QuadraticSystem {
 public:
  explicit QuadraticSystem(int count) : size(count) {}

  void add_constant(int row, const Interval& factor) { add({row, Term::Kind::constant, 0, factor}); }
  void add_variable(int row, int variable, const Interval& factor) {
    add({row, Term::Kind::variable, variable, factor});
  }
  /// A product is formed once, for all components that hold it.
  void add_product(int row, int a, int b, const Interval& factor);

  /// Multiplies the right-hand side by a number: time in other units, or backwards.
  void scale(double factor);

  int size;              ///< variables
  std::vector<Product> products = {};
  std::vector<Term> terms = {};

 private:
  void add(const Term& term);
};

}  // namespace polhode::proof
