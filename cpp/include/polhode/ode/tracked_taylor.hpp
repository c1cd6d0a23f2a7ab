#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "polhode/math/detail/coin.hpp"
#include "polhode/ode/taylor.hpp"

namespace polhode::ode {

/// The error of a run's samples, in the problem's measure. The first three members are input, the others output.
struct ErrorTrace {
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  double asked = 1e-9;             ///< the requested error
  double most = infinity;          ///< the run is given up when its error exceeds `most` times `asked`
  bool all_terms = false;          ///< the error gets all terms of the series, for steps that stability keeps short
  double rate_error = 0.0;         ///< largest error of the first part (rates), absolute
  double attitude_error = 0.0;     ///< largest error of the second part (attitude), an angle
  double holds_until = infinity;   ///< the span from the start in which the samples have the requested error
  double given_up = 0.0;           ///< the span from the start after which the run was given up; 0: it was not
};

/// y' = f(t, y) with a measure of its errors.
template <class P>
concept TrackedProblem = SeriesProblem<P> && requires(const P& problem, const double* y, double* out) {
  /// For a state and a small error of it: the size of the first part, the error of the first part, and the error of the
  /// second part as an angle.
  problem.measure_error(y, y, out);
};

/// Taylor steps that propagate two estimates of their error.
///
/// `loss_` is the sum of what the steps have lost, with its signs: it cancels where the true losses cancel. The loss of a
/// step comes from the defect of its polynomial P at the end, -(P' - f(P)) h / (order + 1): the terms of a series point
/// anywhere, but the defect has the sign of the loss (measured: 0.9 to 1.4 of it, docs/notes/certificates.md).
/// `spread_` is what rounding may have made of the inputs and of each step, and a tenth of each loss. It starts from
/// perturbed inputs, follows perturbed constants, and grows in its own direction, so that it never cancels.
///
/// Both are small and obey the equations linearised about y. So a few terms of their series suffice, which are the
/// differences of the series of y + scale e and of y. If the requested error is below 1e-6, `scale` enlarges it to 1e-6.
/// (Transport of local errors by the linearised equations: Hairer, Norsett & Wanner 1993, I.13 and II.8, for estimates of
/// the global error. Defects: Enright 2000, Numer. Algorithms 25, 137.)
template <TrackedProblem P>
class TrackedTaylor final : public Taylor::Stepper<P> {
  static constexpr int W = series_width;
  static constexpr int error_terms = 12;        // with 7, a few parts in ten thousand are missing in each step
  static constexpr double safety = 1.5;         // on the loss of a step
  static constexpr double unsigned_part = 0.1;  // of the loss, that the spread gets too
  static constexpr double rounding = 0x1p-53;   // of y in a step, whose sums are compensated
  using Base = Taylor::Stepper<P>;

 public:
  /// @param perturbed  the same problem with its constants perturbed by compute_perturbation(trace)
  TrackedTaylor(const P& problem, const P& perturbed, double t0, const double* y0, double t_end,
                const Tolerances& tolerances, ErrorTrace& trace)
      : Base(problem, t0, y0, t_end, tolerances),
        perturbed_(perturbed),
        trace_(trace),
        scale_(find_scale(trace)),
        t0_(t0) {
    for (int i = 0; i < W; ++i) spread_[i] = (coin_.toss() ? 1.0 : -1.0) * compute_perturbation(trace) * y0[i];
    measure();
    old_[0] = now_[0], old_[1] = now_[1];
  }

  /// The relative perturbation of the inputs: half a unit in the last place, enlarged by `scale`.
  static double compute_perturbation(const ErrorTrace& trace) {
    return find_scale(trace) * 0.5 * std::numeric_limits<double>::epsilon();
  }

  StepResult advance(double t_end) override {
    const StepResult result = Base::advance(t_end);
    if (result != StepResult::accepted) return result;
    propagate_errors();
    if (std::max(now_[0] / largest_, now_[1]) > trace_.most * trace_.asked) {
      trace_.given_up = std::abs(this->t_ - t0_);
      return StepResult::not_finite;
    }
    return result;
  }

  void interpolate_many(const double* times, std::size_t n, double* out) override {
    Base::interpolate_many(times, n, out);
    if (n == 0) return;
    trace_.rate_error = std::max({trace_.rate_error, old_[0], now_[0]});
    trace_.attitude_error = std::max({trace_.attitude_error, old_[1], now_[1]});
    if (trace_.rate_error > trace_.asked * largest_ || trace_.attitude_error > trace_.asked) {
      trace_.holds_until = std::min(trace_.holds_until, good_until_);
    } else {
      good_until_ = std::abs(times[n - 1] - t0_);
    }
  }

 private:
  static double find_scale(const ErrorTrace& trace) { return std::max(1.0, 1e-6 / trace.asked); }

  void propagate_errors() {
    const double s = ((this->time_.hi - this->time_old_.hi) + (this->time_.lo - this->time_old_.lo)) / this->unit_old_;
    propagate(this->problem_, s, loss_);
    propagate(perturbed_, s, spread_);
    alignas(64) double loss[W];
    double sizes[3];
    compute_loss(s, loss);
    for (int i = 0; i < W; ++i) loss_[i] += loss[i];
    this->problem_.measure_error(this->y_, loss, sizes);
    restore(loss_);
    restore(spread_);
    grow_spread(scale_ * rounding + unsigned_part * find_relative_error(sizes));
    old_[0] = now_[0], old_[1] = now_[1];
    measure();
  }

  /// A small error over the step, by the difference of two series.
  void propagate(const P& problem, double s, double* error) {
    const int terms = trace_.all_terms ? this->order_ : std::min(this->order_, error_terms);
    alignas(64) double twin[W], propagated[W];
    for (int i = 0; i < W; ++i) twin[i] = this->y_old_[i] + error[i];
    problem.compute_series(this->time_old_, this->unit_old_, twin, twin, terms, twin_rows_);
    for (int k = W; k < W * (terms + 1); ++k) twin_rows_[k] -= this->rows_[k];
    series_kernels().evaluate(twin_rows_, terms, Base::zero, error, &s, 1, propagated);
    std::copy_n(propagated, W, error);
  }

  /// The loss of the step in units of the scaled error, from the defect of its polynomial at the end.
  void compute_loss(double s, double* loss) {
    const int order = this->order_;
    alignas(64) double slope[W];
    for (int k = 1; k <= order; ++k) {   // the rows of P'
      for (int i = 0; i < W; ++i) twin_rows_[W * (k - 1) + i] = k * this->rows_[W * k + i];
    }
    series_kernels().evaluate(twin_rows_, order - 1, twin_rows_, Base::zero, &s, 1, slope);
    constexpr int fewest = Taylor::least_order;   // f is the first row; the kernels compute no fewer
    this->problem_.compute_series(this->time_, this->unit_old_, this->y_, this->carry_, fewest, twin_rows_);
    const double factor = -scale_ * safety * s / (order + 1);
    for (int i = 0; i < W; ++i) loss[i] = factor * (slope[i] - twin_rows_[W + i]);
  }

  /// The larger of the two errors, that of the first part relative to its size.
  static double find_relative_error(const double* sizes) {
    return std::max(sizes[0] > 0.0 ? sizes[1] / sizes[0] : 0.0, sizes[2]);
  }

  /// Applies the correction after a step to the erroneous solution as well.
  void restore(double* error) {
    double twin[W], low[W];
    for (int i = 0; i < W; ++i) {
      const math::DD sum = math::two_sum(this->y_[i], this->carry_[i] + error[i]);
      twin[i] = sum.hi, low[i] = sum.lo;
    }
    this->problem_.correct(this->time_, this->counts_.steps - 1, twin, low);
    for (int i = 0; i < W; ++i) error[i] = (twin[i] - this->y_[i]) + (low[i] - this->carry_[i]);
  }

  /// @param growth  what to add to the spread, relative to y, in its own direction
  void grow_spread(double growth) {
    double sizes[3];
    this->problem_.measure_error(this->y_, spread_, sizes);
    const double relative = find_relative_error(sizes);
    if (!(relative > 0.0 && relative < std::numeric_limits<double>::infinity())) return;
    for (double& u : spread_) u *= 1 + growth / relative;
  }

  void measure() {
    double lost[3], spread[3];
    this->problem_.measure_error(this->y_, loss_, lost);
    this->problem_.measure_error(this->y_, spread_, spread);
    largest_ = std::max(largest_, lost[0]);
    const double rates = lost[1] + spread[1], angle = lost[2] + spread[2];
    // An oscillating error is small at times, so its size is held for a few steps.
    now_[0] = std::max(rates / scale_, 0.7 * now_[0]);
    now_[1] = std::max(angle / scale_, 0.7 * now_[1]);
    if (!(rates + angle < 1e300)) now_[0] = now_[1] = std::numeric_limits<double>::infinity();
  }

  const P& perturbed_;
  ErrorTrace& trace_;
  double scale_, t0_;
  double largest_ = 0.0, now_[2] = {}, old_[2] = {}, good_until_ = 0.0;
  math::Coin coin_;
  alignas(64) double loss_[W] = {}, spread_[W] = {};
  alignas(64) double twin_rows_[W * (most_series_order + 1)] = {};
};

}  // namespace polhode::ode
