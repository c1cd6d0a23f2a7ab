#include "polhode/formula/form.hpp"

namespace polhode::formula {
namespace {

Form add(const Form& a, const Form& b, double sign) {
  Form sum;
  sum.constant = a.constant + sign * b.constant;
  sum.terms.reserve(a.terms.size() + b.terms.size());
  auto left = a.terms.begin(), right = b.terms.begin();
  while (left != a.terms.end() || right != b.terms.end()) {
    if (right == b.terms.end() || (left != a.terms.end() && left->node < right->node)) {
      sum.terms.push_back(*left++);
    } else if (left == a.terms.end() || right->node < left->node) {
      sum.terms.push_back({sign * right->factor, right->node}), ++right;
    } else {
      const double factor = left->factor + sign * right->factor;
      if (factor != 0.0) sum.terms.push_back({factor, left->node});
      ++left, ++right;
    }
  }
  return sum;
}

template <class Change>
Form change_factors(const Form& a, Change change) {
  Form changed;
  changed.constant = change(a.constant) + 0.0;   // not -0
  for (const Term& term : a.terms) {
    const double factor = change(term.factor);
    if (factor != 0.0) changed.terms.push_back({factor, term.node});
  }
  return changed;
}

}  // namespace

Form Form::of(int node) {
  Form form;
  form.terms.push_back({1.0, node});
  return form;
}

Form operator+(const Form& a, const Form& b) { return add(a, b, 1.0); }
Form operator-(const Form& a, const Form& b) { return add(a, b, -1.0); }
Form operator-(const Form& a) {
  return change_factors(a, [](double x) { return -x; });
}
Form operator*(const Form& a, double factor) {
  if (factor == 0.0) return {};
  return change_factors(a, [=](double x) { return x * factor; });
}
Form operator/(const Form& a, double divisor) {
  return change_factors(a, [=](double x) { return x / divisor; });
}

}  // namespace polhode::formula
