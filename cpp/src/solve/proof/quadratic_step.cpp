#include "solve/proof/quadratic_step.hpp"

#include <algorithm>
#include <utility>

namespace polhode::proof {
namespace {

using Kind = Term::Kind;

}  // namespace

QuadraticStep::QuadraticStep(QuadraticSystem system, const StepSettings& settings)
    : TaylorStep(system.size, settings, system.size), system_(std::move(system)) {
  int terms = 0;
  std::vector<int> per_row(to_index(n_), 0);
  for (const Term& term : system_.terms) terms = std::max(terms, ++per_row[to_index(term.row)]);
  set_rounding((order_ + terms + 12) * unit);
  derivative_rounding_ = (2 * order_ + 2 * terms + 12) * unit;
  first_.resize(to_index(order_ + 1) * system_.products.size()), second_.resize(first_.size());
  prepare_pairs();
}

void QuadraticStep::expand_state(const Interval&) {
  const std::size_t count = system_.products.size();
  std::vector<double> product(count), sum(to_index(n_));
  std::vector<DD> fine_product(count), fine_sum(to_index(n_));
  for (int k = 0; k < order_; ++k) {
    for (std::size_t p = 0; p < count; ++p) {
      first_[to_index(k) * count + p] = P(system_.products[p].a)[k];
      second_[to_index(k) * count + p] = P(system_.products[p].b)[k];
    }
    if (k < fine_) {
      for (std::size_t p = 0; p < count; ++p) {
        const double *a = P(system_.products[p].a), *b = P(system_.products[p].b);
        const double *a_low = &low_[to_index(a - high_.data())],
                     *b_low = &low_[to_index(b - high_.data())];
        DD s;
        for (int i = 0; i <= k; ++i) s = s + DD(a[i], a_low[i]) * DD(b[k - i], b_low[k - i]);
        fine_product[p] = s;
      }
      std::fill(fine_sum.begin(), fine_sum.end(), DD());
      for (const Term& term : system_.terms) {
        const auto source = to_index(term.source);
        DD& s = fine_sum[to_index(term.row)];
        const DD& factor = term.factor.middle;
        if (term.kind == Kind::product) s = s + factor * fine_product[source];
        else if (term.kind == Kind::variable)
          s = s + factor * DD(P(term.source)[k], low_[source * to_index(order_ + 1) + to_index(k)]);
        else if (k == 0) s = s + factor;
      }
      for (int v = 0; v < n_; ++v) {
        const DD next = fine_sum[to_index(v)] / DD(k + 1.0);
        P(v)[k + 1] = next.hi;
        low_[to_index(v * (order_ + 1) + k + 1)] = next.lo;
      }
      continue;
    }
    std::fill(product.begin(), product.end(), 0.0);
    for (int i = 0; i <= k; ++i) {
      const double *a = &first_[to_index(i) * count], *b = &second_[to_index(k - i) * count];
      for (std::size_t p = 0; p < count; ++p) product[p] += a[p] * b[p];
    }
    std::fill(sum.begin(), sum.end(), 0.0);
    for (const Term& term : system_.terms) {
      if (term.kind == Kind::constant) continue;   // fine_ is at least 1
      const double source = term.kind == Kind::product ? product[to_index(term.source)] : P(term.source)[k];
      sum[to_index(term.row)] += term.factor.middle.hi * source;
    }
    for (int v = 0; v < n_; ++v) P(v)[k + 1] = sum[to_index(v)] / (k + 1);
  }
}

void QuadraticStep::expand_derivative() {
  const auto w = to_index(width_);
  std::fill_n(derivative_.begin(), to_index(n_) * w, 0.0);
  for (int v = 0; v < n_; ++v) F(0, v)[v] = 1.0;
  std::vector<double> product(system_.products.size() * w);
  for (int k = 0; k < derivative_order_; ++k) {
    std::fill(product.begin(), product.end(), 0.0);
    for (std::size_t p = 0; p < system_.products.size(); ++p) {
      const Product& pair = system_.products[p];
      const double *a = P(pair.a), *b = P(pair.b);
      double* sum = &product[p * w];
      for (int i = 0; i <= k; ++i) {
        const double *da = F(i, pair.a), *db = F(i, pair.b);
        const double s = a[k - i], t = b[k - i];
        for (std::size_t c = 0; c < w; ++c) sum[c] += s * db[c] + t * da[c];
      }
    }
    std::fill_n(F(k + 1, 0), to_index(n_) * w, 0.0);
    for (const Term& term : system_.terms) {
      if (term.kind == Kind::constant) continue;
      const double* source = term.kind == Kind::product ? &product[to_index(term.source) * w] : F(k, term.source);
      const double factor = term.factor.middle.hi;
      double* row = F(k + 1, term.row);
      for (std::size_t c = 0; c < w; ++c) row[c] += factor * source[c];
    }
    double* rows = F(k + 1, 0);
    for (std::size_t c = 0; c < to_index(n_) * w; ++c) rows[c] /= k + 1;
  }
}

}  // namespace polhode::proof
