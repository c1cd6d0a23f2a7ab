#include "solve/proof/taylor_step.hpp"

#include <algorithm>
#include <cmath>

#include "polhode/math/detail/functions.hpp"

namespace polhode::proof {
TaylorStep::TaylorStep(int size, const StepSettings& settings, int first_own)
    : settings_(settings), n_(size), width_((size + 3) / 4 * 4), first_own_(first_own) {
  // Order as in Jorba & Zou 2005, Experimental Mathematics 14, 99.
  order_ = std::clamp(static_cast<int>(std::lround(0.5 * -math::log(settings_.tolerance))) + 1, 8, 40);
  next_derivative_order_ = std::min(12, order_);
  const auto n = to_index(n_), rows = to_index(order_ + 1);
  high_.resize(n * rows), low_.resize(n * rows), sizes_.resize(n * rows), tails_.resize(n * rows);
  powers_.resize(rows), images_.resize(n * rows);
  derivative_.resize(rows * n * to_index(width_));
  defect_.resize(n), rest_.resize(n), spread_.resize(n), jacobian_.resize(n * n);
  largest_.assign(n, 1.0);
  std::fill_n(largest_.begin(), 3, 0.0);
}

/// Low halves as far as plain rounding would count.
void TaylorStep::set_rounding(double rounding) {
  rounding_ = rounding;
  const double digits = -math::log(settings_.tolerance);
  fine_ = std::clamp(static_cast<int>(std::ceil(order_ * (1.0 + math::log(rounding_) / digits))), 1, order_ - 1);
}

double TaylorStep::expand(std::span<const DD> state, const Interval& now) {
  const auto rows = to_index(order_ + 1);
  for (std::size_t v = 0; v < state.size(); ++v) high_[v * rows] = state[v].hi, low_[v * rows] = state[v].lo;
  double rate = std::max(largest_rate(), 0x1p-20);
  for (int v = 0; v < 3; ++v) rate = std::max(rate, std::abs(P(v)[0]));
  std::fill_n(largest_.begin(), 3, rate);
  for (int v = first_own_; v < n_; ++v) largest_[to_index(v)] = std::max(largest_size(v), std::abs(P(v)[0]));
  expand_state(now);
  derivative_order_ = next_derivative_order_;
  expand_derivative();

  // Both of the last two terms within the tolerance: one of them may happen to be small.
  double length = 1e300;
  const auto limit = [&](double size, double tolerance, int k) {
    if (size > 0.0) length = std::min(length, math::fast_pow(tolerance / size, 1.0 / k));
  };
  for (int k = order_ - 1; k <= order_; ++k) {
    double largest = 0.0;
    for (int v = 0; v < n_; ++v) largest = std::max(largest, std::abs(P(v)[k]) / largest_size(v));
    limit(largest, settings_.tolerance, k);
  }
  const double by_state = length;
  double by_derivative = 1e300;
  for (int k = derivative_order_ - 1; k <= derivative_order_; ++k) {
    double largest = 0.0;
    for (int v = 0; v < n_; ++v)
      for (int c = 0; c < n_; ++c) largest = std::max(largest, std::abs(F(k, v)[c]));
    limit(largest, settings_.derivative_tolerance, k);
  }
  by_derivative = length;
  // A stiff body's derivative needs more terms than the motion itself.
  if (by_derivative < 0.7 * by_state) next_derivative_order_ = std::min(order_, derivative_order_ + 2);
  else if (by_derivative > 0.95 * by_state && derivative_order_ > 10) next_derivative_order_ = derivative_order_ - 1;
  return shorten(length);
}

void TaylorStep::evaluate(DD time, double slack, std::vector<DD>& state, std::vector<double>& lost) const {
  const auto rows = to_index(order_ + 1);
  // |P'| <= sum of k |P_k| t^(k-1), with t at most the step's length
  const double per_time = order_ / powers_[1];
  for (int v = 0; v < n_; ++v) {
    const double* c = P(v);
    const double* c_low = &low_[to_index(v) * rows];
    double coarse = 0.0;
    for (int k = order_; k > fine_; --k) coarse = coarse * time.hi + c[k];
    DD sum(coarse);
    for (int k = fine_; k >= 0; --k) sum = sum * time + DD(c[k], c_low[k]);
    state[to_index(v)] = sum;
    lost[to_index(v)] = raised(3 * order_ * unit * sum_from(v, fine_ + 1) + fine_rounding * sum_from(v, 0) +
                                               slack * per_time * sum_from(v, 1));
  }
}

void TaylorStep::evaluate_derivative(double time, double slack, std::vector<double>& result,
                                     std::vector<double>& lost) const {
  const auto count = to_index(n_ * width_);
  result.assign(F(derivative_order_, 0), F(derivative_order_, 0) + count);
  for (int k = derivative_order_ - 1; k >= 0; --k) {
    const double* rows = F(k, 0);
    for (std::size_t c = 0; c < count; ++c) result[c] = result[c] * time + rows[c];
  }
  // The time is rounded to a double, too. spread_ bounds what |F| makes of the box.
  const double part = (6.0 * derivative_order_ + 4.0 * n_ + 8.0) * unit + slack * derivative_order_ / powers_[1];
  for (std::size_t v = 0; v < lost.size(); ++v) lost[v] = raised(part * spread_[v]);
}

}  // namespace polhode::proof
