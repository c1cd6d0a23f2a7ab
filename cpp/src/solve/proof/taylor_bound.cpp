#include <algorithm>
#include <cmath>

#include "polhode/math/detail/number.hpp"
#include "solve/proof/taylor_step.hpp"

// What the polynomials of a step leave out, bounded.
namespace polhode::proof {
namespace {

constexpr double most = 0x1p60;             // no size may be larger: see raised()

}  // namespace

void TaylorStep::compute_sizes(double length) {
  powers_[0] = 1.0;
  // A power that underflows would hide a large coefficient.
  for (int k = 1; k <= order_; ++k) powers_[to_index(k)] = std::max(powers_[to_index(k - 1)] * length, 0x1p-900);
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

/// The sizes of F box, and in `spread_` their sums.
void TaylorStep::compute_images(const std::vector<double>& box) {
  const auto n = to_index(n_);
  std::fill(spread_.begin(), spread_.end(), 0.0);
  for (int j = 0; j <= derivative_order_; ++j)
    for (int v = 0; v < n_; ++v) {
      const double* row = F(j, v);
      double sum = 0.0;
      for (std::size_t c = 0; c < n; ++c) sum += std::abs(row[c]) * box[c];
      const double size = sum * powers_[to_index(j)];
      images_[to_index(j) * n + to_index(v)] = size;
      spread_[to_index(v)] += size;
    }
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
  const std::vector<double> box = errors.box();
  compute_images(box);
  if (!compute_defects(box)) return false;
  for (double& spread : spread_) spread = raised(spread);

  compute_jacobian();
  const double growth = raised(compute_growth() * length);
  // A slow body turns little in a long step, but an error of its rates shifts its attitude without end. In units of a
  // radian over the step this is no growth. Else a body at rest would need a step for every 100 s.
  if (!std::isfinite(growth)) return false;
  const bool is_long = growth >= 40.0;
  const double rate_unit = is_long ? math::power_of_two_below(std::min(1.0, 1.0 / length)) : 1.0;
  const double stretch = is_long ? 0.0 : raised(length * exp_above(growth));

  // N(e) needs a bound on e, which holds the bound on r that is sought: it is guessed and then confirmed.
  const std::vector<double> linear = spread_;
  std::vector<double> guess(n, 0.0), source(n), found(n);
  for (int attempt = 0; attempt < 6; ++attempt) {
    for (std::size_t i = 0; i < n; ++i) spread_[i] = raised(linear[i] + guess[i]);
    source = defect_;
    if (!add_second_order(source)) return false;
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
