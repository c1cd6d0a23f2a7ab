#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "polhode/math/detail/coin.hpp"
#include "polhode/math/detail/functions.hpp"
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

/// Taylor steps that propagate an estimate of their error: e, the distance of a twin solution from y.
///
/// The twin takes the same steps. In each step it loses 2.5 times the estimated truncation error, and it starts from
/// inputs that are rounded once more. e is small and obeys the equations linearised about y, so that a few terms of its
/// series suffice. These are the differences of the series of y + scale e and of y. If the requested error is below
/// 1e-6, `scale` enlarges it to 1e-6. (Transport of local errors by the linearised equations: Hairer, Norsett & Wanner
/// 1993, I.13 and II.8, for estimates of the global error.)
template <TrackedProblem P>
class TrackedTaylor final : public Taylor::Stepper<P> {
  static constexpr int W = series_width;
  static constexpr int error_terms = 7;         // enough for a step's effect on the error to a part in a thousand
  static constexpr double safety = 2.5;         // on the truncation error of a step
  static constexpr double aligned = 0.1;        // the part of it that is added along the present error
  static constexpr double rounding = 0x1p-54;   // rounding error of y in a step, whose sums are compensated
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
    for (int i = 0; i < W; ++i) error_[i] = (coin_.toss() ? 1.0 : -1.0) * compute_perturbation(trace) * y0[i];
    measure(0.0);
    old_[0] = now_[0], old_[1] = now_[1];
  }

  /// The relative perturbation of the inputs: half a unit in the last place, enlarged by `scale`.
  static double compute_perturbation(const ErrorTrace& trace) {
    return find_scale(trace) * 0.5 * std::numeric_limits<double>::epsilon();
  }

  StepResult advance(double t_end) override {
    const StepResult result = Base::advance(t_end);
    if (result != StepResult::accepted) return result;
    propagate_error();
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

  void propagate_error() {
    const int order = this->order_, terms = trace_.all_terms ? order : std::min(order - 1, error_terms);
    const double* rows = this->rows_;
    const double s = ((this->time_.hi - this->time_old_.hi) + (this->time_.lo - this->time_old_.lo)) / this->unit_old_;
    alignas(64) double twin[W], propagated[W];
    for (int i = 0; i < W; ++i) twin[i] = this->y_old_[i] + error_[i];
    perturbed_.compute_series(this->time_old_, this->unit_old_, twin, twin, terms, twin_rows_);
    for (int k = W; k < W * (terms + 1); ++k) twin_rows_[k] -= rows[k];
    series_kernels().evaluate(twin_rows_, terms, Base::zero, error_, &s, 1, propagated);
    // The truncation error, from the largest of the last four terms: one or two of them may happen to be small.
    double loss[W] = {}, sizes[3], power = scale_ * safety * shrink_ * math::power(std::abs(s), order);
    for (int k = order; k > order - 4; --k, power *= shrink_ / std::abs(s)) {
      for (int i = 0; i < W; ++i) loss[i] = std::max(loss[i], std::abs(rows[W * k + i]) * power);
    }
    for (int i = 0; i < W; ++i) {
      loss[i] = std::copysign(loss[i], rows[W * order + i]);
      error_[i] = propagated[i] + loss[i];
    }
    this->problem_.measure_error(this->y_, loss, sizes);
    restore();
    old_[0] = now_[0], old_[1] = now_[1];
    measure(scale_ * rounding + aligned * find_relative_error(sizes));
  }

  /// The larger of the two errors, that of the first part relative to its size.
  static double find_relative_error(const double* sizes) {
    return std::max(sizes[0] > 0.0 ? sizes[1] / sizes[0] : 0.0, sizes[2]);
  }

  /// Applies the correction after a step to the twin as well.
  void restore() {
    double twin[W], low[W];
    for (int i = 0; i < W; ++i) {
      const math::DD sum = math::two_sum(this->y_[i], this->carry_[i] + error_[i]);
      twin[i] = sum.hi, low[i] = sum.lo;
    }
    this->problem_.correct(this->time_, this->counts_.steps - 1, twin, low);
    for (int i = 0; i < W; ++i) error_[i] = (twin[i] - this->y_[i]) + (low[i] - this->carry_[i]);
  }

  /// Measures the error, after adding to it.
  /// @param growth  what to add, relative to y, along the present error: in another direction it might not grow, and
  ///                opposite signs might cancel by chance
  void measure(double growth) {
    double out[3];
    this->problem_.measure_error(this->y_, error_, out);
    largest_ = std::max(largest_, out[0]);
    const double relative = find_relative_error(out);
    if (relative > 0.0 && relative < std::numeric_limits<double>::infinity()) {
      const double factor = 1 + growth / relative;
      for (double& e : error_) e *= factor;
      out[1] *= factor, out[2] *= factor;
    }
    // An oscillating error is small at times, so its size is held for a few steps.
    now_[0] = std::max(out[1] / scale_, 0.7 * now_[0]);
    now_[1] = std::max(out[2] / scale_, 0.7 * now_[1]);
    if (!(out[1] + out[2] < 1e300)) now_[0] = now_[1] = std::numeric_limits<double>::infinity();
  }

  const P& perturbed_;
  ErrorTrace& trace_;
  double scale_, t0_;
  // the ratio of successive terms by the rule for the step
  double shrink_ = math::fast_pow(this->tolerances_.rtol, 1.0 / (this->order_ - 1));
  double largest_ = 0.0, now_[2] = {}, old_[2] = {}, good_until_ = 0.0;
  math::Coin coin_;
  alignas(64) double error_[W] = {};
  alignas(64) double twin_rows_[W * (most_series_order + 1)] = {};
};

}  // namespace polhode::ode
