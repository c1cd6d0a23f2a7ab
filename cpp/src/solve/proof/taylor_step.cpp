#include "solve/proof/taylor_step.hpp"

#include <algorithm>
#include <cmath>

#include "polhode/math/detail/functions.hpp"

namespace polhode::proof {
namespace {

using Kind = Term::Kind;

constexpr double unit = 0x1p-53;

}  // namespace

TaylorStep::TaylorStep(const QuadraticSystem& system, const StepSettings& settings)
    : system_(system), settings_(settings), n_(system.size), width_((system.size + 3) / 4 * 4) {
  // Order as in Jorba & Zou 2005, Experimental Mathematics 14, 99; low halves as far as plain rounding would count.
  const double digits = -math::log(settings_.tolerance);
  order_ = std::clamp(static_cast<int>(std::lround(0.5 * digits)) + 1, 8, 40);
  next_derivative_order_ = std::min(12, order_);
  int terms = 0;
  std::vector<int> per_row(to_index(n_), 0);
  for (const Term& term : system_.terms) terms = std::max(terms, ++per_row[to_index(term.row)]);
  rounding_ = (order_ + terms + 12) * unit;
  derivative_rounding_ = (2 * order_ + 2 * terms + 12) * unit;
  fine_ = std::clamp(static_cast<int>(std::ceil(order_ * (1.0 + math::log(rounding_) / digits))), 1, order_ - 1);
  const auto n = to_index(n_), rows = to_index(order_ + 1);
  high_.resize(n * rows), low_.resize(n * rows), sizes_.resize(n * rows), tails_.resize(n * rows);
  powers_.resize(rows), images_.resize(n * rows);
  derivative_.resize(rows * n * to_index(width_));
  first_.resize(rows * system_.products.size()), second_.resize(first_.size());
  defect_.resize(n), rest_.resize(n), spread_.resize(n), jacobian_.resize(n * n);
  prepare_pairs();
}

double TaylorStep::expand(std::span<const DD> state) {
  const auto rows = to_index(order_ + 1);
  for (std::size_t v = 0; v < state.size(); ++v) high_[v * rows] = state[v].hi, low_[v * rows] = state[v].lo;
  double rate = 0.0;
  for (int v = 0; v < 3; ++v) rate = std::max(rate, std::abs(P(v)[0]));
  largest_rate_ = std::max({largest_rate_, rate, 0x1p-20});
  expand_state();
  derivative_order_ = next_derivative_order_;
  expand_derivative();

  // Both of the last two terms within the tolerance: one of them may happen to be small.
  double length = 1e300;
  const auto limit = [&](double size, double tolerance, int k) {
    if (size > 0.0) length = std::min(length, math::fast_pow(tolerance / size, 1.0 / k));
  };
  for (int k = order_ - 1; k <= order_; ++k) {
    double largest = 0.0;
    for (int v = 0; v < n_; ++v) largest = std::max(largest, std::abs(P(v)[k]) / (v < 3 ? largest_rate_ : 1.0));
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
  return length;
}

void TaylorStep::expand_state() {
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

void TaylorStep::expand_derivative() {
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
