#pragma once

#include <vector>

namespace polhode::formula {

/// A factor times the value of a node.
struct Term {
  double factor;
  int node;

  friend bool operator==(const Term&, const Term&) = default;
};

/// constant + sum of factor * node. Terms are sorted by node, each node occurs once, and no factor is 0.
///
/// An expression under construction is a form. So sums, differences and constant factors make no operation.
struct Form {
  double constant = 0.0;
  std::vector<Term> terms;

  Form() = default;
  Form(double value) : constant(value) {}   // NOLINT(google-explicit-constructor)
  /// A node itself.
  static Form of(int node);

  bool is_constant() const { return terms.empty(); }
  bool is_zero() const { return terms.empty() && constant == 0.0; }

  friend bool operator==(const Form&, const Form&) = default;
};

Form operator+(const Form& a, const Form& b);
Form operator-(const Form& a, const Form& b);
Form operator-(const Form& a);
/// Each coefficient is rounded once. A factor 0 gives the form 0.
Form operator*(const Form& a, double factor);
Form operator/(const Form& a, double divisor);

}  // namespace polhode::formula
