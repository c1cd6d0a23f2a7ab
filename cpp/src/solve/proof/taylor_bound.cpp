#include <algorithm>
#include <cmath>

#include "polhode/math/detail/number.hpp"
#include "solve/proof/taylor_step.hpp"

// What the polynomials of a step leave out, bounded.
namespace polhode::proof {
namespace {

using Kind = Term::Kind;

constexpr double most = 0x1p60;             // no size may be larger: see raised()

/// At least e^x, 0 <= x <= 60.
double exp_above(double x) {
  double sum = 1.0, term = 1.0;
  for (int k = 1; k <= 200; ++k) {
    term *= x / k;
    sum += term;
  }
  return raised(sum * (1.0 + 0x1p-40));   // what is left out: 60^200 / 200! is far below a part in 2^40
}

}  // namespace

void TaylorStep::prepare_pairs() {
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

void TaylorStep::compute_sizes(double length) {
  powers_[0] = 1.0;
  for (int k = 1; k <= order_; ++k) powers_[to_index(k)] = powers_[to_index(k - 1)] * length;
  for (int v = 0; v < n_; ++v) {
    double sum = 0.0;
    for (int k = order_; k >= 0; --k) {
      const std::size_t at = to_index(v * (order_ + 1) + k);
      sizes_[at] = std::abs(high_[at]) * powers_[to_index(k)];
      sum += sizes_[at];
      tails_[at] = sum;
    }
  }
}

/// |d| + |D| box over the step, by components. The terms of f(P) from t^order on and those of J F from
/// t^derivative_order on are left out of the series; below that only rounding separates the series from the equations.
void TaylorStep::compute_defects(const std::vector<double>& box) {
  const auto n = to_index(n_);
  const int M = derivative_order_;
  for (int j = 0; j <= M; ++j)
    for (int v = 0; v < n_; ++v) {
      const double* row = F(j, v);
      double sum = 0.0;
      for (std::size_t c = 0; c < n; ++c) sum += std::abs(row[c]) * box[c];
      images_[to_index(j) * n + to_index(v)] = sum * powers_[to_index(j)];
    }
  const auto image = [&](int j, int v) { return images_[to_index(j) * n + to_index(v)]; };
  std::fill(spread_.begin(), spread_.end(), 0.0);
  for (int j = 0; j <= M; ++j)
    for (int v = 0; v < n_; ++v) spread_[to_index(v)] += image(j, v);

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
  for (double& spread : spread_) spread = raised(spread);
}

/// An upper bound on the Euclidean logarithmic norm of J anywhere on the step: Gershgorin's circles of (J + J^T) / 2.
double TaylorStep::compute_growth() const {
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

/// x(length) of x' = A x + source, x(0) = 0, with A_ij >= |J_ij| and A_ii >= max(0, J_ii): it bounds |r_i| and grows.
/// The components of the rates are measured in `rate_unit`, a power of two.
void TaylorStep::compare_by_components(double length, double rate_unit, const std::vector<double>& source,
                                       std::vector<double>& result) const {
  const auto n = to_index(n_);
  std::vector<double> term(n), next(n);
  double largest_row = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < n; ++j) sum += jacobian_[i * n + j] * (j < 3 ? rate_unit : 1.0);
    largest_row = std::max(largest_row, raised(i < 3 ? sum / rate_unit : sum) * length);
    term[i] = source[i] * length;
    result[i] = term[i];
  }
  if (!(largest_row < 40.0)) {
    std::fill(result.begin(), result.end(), 1e300);
    return;
  }
  const int terms = 12 + static_cast<int>(2.0 * largest_row);
  for (int k = 1; k <= terms; ++k) {
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j < n; ++j) sum += jacobian_[i * n + j] * term[j];
      next[i] = sum * length / (k + 1);
    }
    std::swap(term, next);
    for (std::size_t i = 0; i < n; ++i) result[i] += term[i];
  }
  // Each further term is at most half the last one's largest component.
  double left = 0.0;
  for (std::size_t i = 0; i < n; ++i) left = std::max(left, i < 3 ? term[i] / rate_unit : term[i]);
  for (std::size_t i = 0; i < n; ++i) result[i] = raised(result[i] + (i < 3 ? left * rate_unit : left));
}

bool TaylorStep::bound(double asked_length, const ErrorSet& errors) {
  const double length = asked_length * margin;
  const auto n = to_index(n_);
  compute_sizes(length);
  for (int v = 0; v < n_; ++v)
    if (!(sum_from(v, 0) < most)) return false;
  compute_defects(errors.box());

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
  const double growth = raised(compute_growth() * length);
  // A slow body turns little in a long step, but an error of its rates shifts its attitude without end. In units of a
  // radian over the step this is no growth. Else a body at rest would need a step for every 100 s.
  if (!std::isfinite(growth)) return false;
  const bool is_long = growth >= 40.0;
  const double rate_unit = is_long ? math::power_of_two_below(std::min(1.0, 1.0 / length)) : 1.0;
  const double stretch = is_long ? 0.0 : raised(length * exp_above(growth));

  // Q(e, e) needs a bound on e, which holds the bound on r that is sought: it is guessed and then confirmed.
  const std::vector<double> linear = spread_;
  std::vector<double> guess(n, 0.0), source(n), found(n);
  for (int attempt = 0; attempt < 6; ++attempt) {
    for (std::size_t i = 0; i < n; ++i) spread_[i] = raised(linear[i] + guess[i]);
    source = defect_;
    for (const Term& term : system_.terms) {
      if (term.kind != Kind::product) continue;
      const Product& product = system_.products[to_index(term.source)];
      source[to_index(term.row)] += raised(term.factor.magnitude() * spread_[to_index(product.a)] *
                                                           spread_[to_index(product.b)]);
    }
    double square = 0.0;
    for (double& value : source) value = raised(value), square += value * value;
    const double by_length = raised(std::sqrt(square) * stretch);
    compare_by_components(length, rate_unit, source, found);
    bool confirmed = true;
    for (std::size_t i = 0; i < n; ++i) {
      if (!is_long) found[i] = std::min(found[i], by_length);
      if (!(found[i] < most)) return false;
      confirmed &= found[i] < guess[i];
    }
    if (confirmed) {
      rest_ = found;
      return true;
    }
    for (std::size_t i = 0; i < n; ++i) guess[i] = (attempt == 0 ? 1.01 : 2.0) * found[i] + 0x1p-800;
  }
  return false;
}

}  // namespace polhode::proof
