#include <algorithm>
#include <cmath>

#include "solve/proof/quadratic_step.hpp"

// What the polynomials of a step of a quadratic system leave out, bounded.
namespace polhode::proof {
namespace {

using Kind = Term::Kind;

}  // namespace

void QuadraticStep::prepare_pairs() {
  struct Sum {
    Interval constant = {};
    std::vector<Interval> factors;
  };
  const auto n = to_index(n_);
  std::vector<Sum> sums(n * n);
  for (Sum& sum : sums) sum.factors.resize(n);
  const auto at = [&](int i, int j) -> Sum& {
    return sums[to_index(std::min(i, j)) * n + to_index(std::max(i, j))];
  };
  for (const Term& term : system_.terms) {
    const int i = term.row;
    // J_ij holds factor times the variable; on the diagonal it counts twice.
    const auto add = [&](int j, int variable) {
      const Interval factor = i == j ? Interval(2.0) * term.factor : term.factor;
      Interval& sum = variable < 0 ? at(i, j).constant : at(i, j).factors[to_index(variable)];
      sum = sum + factor;
    };
    if (term.kind == Kind::variable) add(term.source, -1);
    if (term.kind == Kind::product) {
      const Product& product = system_.products[to_index(term.source)];
      add(product.a, product.b), add(product.b, product.a);
    }
  }
  for (int i = 0; i < n_; ++i)
    for (int j = i; j < n_; ++j) {
      const Sum& sum = at(i, j);
      SymmetricEntry entry{i, j, i == j ? sum.constant.upper() : sum.constant.magnitude(), {}};
      for (int v = 0; v < n_; ++v) {
        const Interval& factor = sum.factors[to_index(v)];
        if (!factor.is_zero()) entry.factors.emplace_back(v, factor.magnitude());
      }
      if (entry.constant != 0.0 || !entry.factors.empty()) symmetric_.push_back(std::move(entry));
    }
}

/// |d| + |D| box over the step, by components. The terms of f(P) from t^order on and those of J F from
/// t^derivative_order on are left out of the series; below that only rounding separates the series from the equations.
bool QuadraticStep::compute_defects(const std::vector<double>&) {
  const int M = derivative_order_;
  struct Sizes {
    double all, coarse, left_out, derivative, derivative_left_out;
  };
  const auto of_variable = [&](int v) -> Sizes {
    return {sum_from(v, 0), sum_from(v, fine_), sum_from(v, order_), spread_[to_index(v)], image(M, v)};
  };
  const auto of_product = [&](const Product& product) {
    const int a = product.a, b = product.b;
    Sizes sizes{sum_from(a, 0) * sum_from(b, 0), 0.0, 0.0, 0.0, 0.0};
    for (int i = 0; i <= order_; ++i) {
      const double size = sizes_[to_index(a * (order_ + 1) + i)];
      sizes.coarse += size * sum_from(b, fine_ - i);
      sizes.left_out += size * sum_from(b, order_ - i);
    }
    sizes.derivative = sum_from(a, 0) * spread_[to_index(b)] +
                       sum_from(b, 0) * spread_[to_index(a)];
    for (int j = 0; j <= M; ++j)
      sizes.derivative_left_out += sum_from(a, M - j) * image(j, b) + sum_from(b, M - j) * image(j, a);
    return sizes;
  };
  std::vector<Sizes> of_products;
  for (const Product& product : system_.products) of_products.push_back(of_product(product));

  std::fill(defect_.begin(), defect_.end(), 0.0);
  for (const Term& term : system_.terms) {
    const double factor = std::abs(term.factor.middle.hi);
    const double fine = term.factor.radius + fine_rounding * factor;
    const double coarse = fine + std::abs(term.factor.middle.lo) + rounding_ * factor;
    const double derivative = fine + std::abs(term.factor.middle.lo) + derivative_rounding_ * factor;
    double& defect = defect_[to_index(term.row)];
    if (term.kind == Kind::constant) {
      defect += fine;
      continue;
    }
    const Sizes sizes = term.kind == Kind::product ? of_products[to_index(term.source)] : of_variable(term.source);
    defect += fine * sizes.all + coarse * sizes.coarse + derivative * sizes.derivative +
              settings_.remainder_factor * (factor * (sizes.left_out + sizes.derivative_left_out));
  }
  for (double& defect : defect_) defect = raised(defect);
  return true;
}

/// An upper bound on the Euclidean logarithmic norm of J anywhere on the step: Gershgorin's circles of (J + J^T) / 2.
double QuadraticStep::compute_growth() const {
  // Damping is negative on the diagonal. It is kept apart, so that rounding is small beside each part.
  std::vector<double> added(to_index(n_), 0.0), subtracted(added);
  for (const SymmetricEntry& entry : symmetric_) {
    double size = std::max(entry.constant, 0.0);
    for (const auto& [variable, factor] : entry.factors) size += factor * sum_from(variable, 0);
    added[to_index(entry.i)] += size;
    if (entry.i != entry.j) added[to_index(entry.j)] += size;
    else subtracted[to_index(entry.i)] = std::max(-entry.constant, 0.0);
  }
  double largest = 0.0;
  for (std::size_t i = 0; i < added.size(); ++i)
    largest = std::max(largest, raised(added[i]) * (1.0 + 0x1p-50) - subtracted[i] * (1.0 - 0x1p-50));
  return raised(0.5 * largest);
}

void QuadraticStep::compute_jacobian() {
  const auto n = to_index(n_);
  std::fill(jacobian_.begin(), jacobian_.end(), 0.0);
  std::vector<double> diagonal(n, 0.0);   // the signed constant parts
  for (const Term& term : system_.terms) {
    const auto row = to_index(term.row);
    const double factor = term.factor.magnitude();
    if (term.kind == Kind::variable) {
      if (term.source == term.row) diagonal[row] += term.factor.upper();
      else jacobian_[row * n + to_index(term.source)] += factor;
    } else if (term.kind == Kind::product) {
      const Product& product = system_.products[to_index(term.source)];
      jacobian_[row * n + to_index(product.a)] += factor * sum_from(product.b, 0);
      jacobian_[row * n + to_index(product.b)] += factor * sum_from(product.a, 0);
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    double& entry = jacobian_[i * n + i];
    entry = std::max(0.0, entry * (1.0 + 0x1p-30) + diagonal[i] + 0x1p-48 * std::abs(diagonal[i]));
  }
  for (double& entry : jacobian_) entry = raised(entry);
}

bool QuadraticStep::add_second_order(std::vector<double>& source) {
  for (const Term& term : system_.terms) {
    if (term.kind != Kind::product) continue;
    const Product& product = system_.products[to_index(term.source)];
    source[to_index(term.row)] += raised(term.factor.magnitude() * spread_[to_index(product.a)] *
                                         spread_[to_index(product.b)]);
  }
  return true;
}

}  // namespace polhode::proof
