#include "solve/proof/quadratic_system.hpp"

#include <algorithm>

namespace polhode::proof {

void QuadraticSystem::add_product(int row, int a, int b, const Interval& factor) {
  if (factor.is_zero()) return;
  if (a > b) std::swap(a, b);
  auto at = std::find_if(products.begin(), products.end(), [&](const Product& p) { return p.a == a && p.b == b; });
  if (at == products.end()) at = products.insert(at, {a, b});
  add({row, Term::Kind::product, static_cast<int>(at - products.begin()), factor});
}

void QuadraticSystem::scale(double factor) {
  for (Term& term : terms) term.factor = Interval(factor) * term.factor;
}

void QuadraticSystem::add(const Term& term) {
  if (term.factor.is_zero()) return;
  for (Term& there : terms) {
    if (there.row != term.row || there.kind != term.kind || there.source != term.source) continue;
    there.factor = there.factor + term.factor;
    return;
  }
  terms.push_back(term);
}

}  // namespace polhode::proof
