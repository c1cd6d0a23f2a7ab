#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "polhode/ode/taylor.hpp"

namespace polhode::ode {

/// What is known of the error of a run's samples, measured as the problem measures it.
struct ErrorTrace {
  double asked = 1e-9;         ///< in: the error that matters
  double most = std::numeric_limits<double>::infinity();   ///< in: times what is asked, after which the run is given up
  bool all_terms = false;   ///< in: as long a series for the error as for the motion (steps short for stability's sake)
  double moved = 0.0;          ///< out: largest error of the first part (rates), absolute
  double turned = 0.0;         ///< out: largest error of the second (attitude), an angle
  double parting =
      std::numeric_limits<double>::infinity();   ///< out: how far from the start the samples are as good as asked
  double given_up = 0.0;       ///< out: how far from the start the run was given up; 0: it was not
};

/// y' = f(t, y) whose errors can be carried along.
template <class P>
concept TrackedProblem = SeriesProblem<P> && requires(const P& problem, const double* y, double* out) {
  /// Of a state and a small error of it: the size of the first part, its error, and the error of the second as an
  /// angle.
  problem.measure_error(y, y, out);
};

/// A Taylor series that carries its own error along: e, how far from y a twin would be that takes the same steps, loses
/// in each more than twice what is left out there, and starts from inputs that are rounded once more. The twin need not
/// be stepped: e is small, so that it follows the equations linearised about y, and few terms of their series do. They
/// are differences of two series, that of y and that of y + scale e, where scale brings an error of less than a
/// millionth that is asked for to a millionth. (Linearised transport of the local errors: Hairer, Norsett & Wanner
/// 1993, I.13 and II.8, there for estimates of the global error.)
template <TrackedProblem P>
class TrackedTaylor final : public Taylor::Stepper<P> {
  static constexpr int W = series_width;
  static constexpr int few = 7;   // terms for the error: to a part in a thousand of what a step does to it
  static constexpr double safety = 2.5;         // on what a step leaves out
  static constexpr double aligned = 0.1;        // of it, whatever its sign
  static constexpr double rounding = 0x1p-54;   // of y, in a step, whose sums are compensated
  using Base = Taylor::Stepper<P>;

 public:
  /// @param moved  the same problem with its constants moved by compute_move(trace)
  TrackedTaylor(const P& problem, const P& moved, double t0, const double* y0, double t_end,
                const Tolerances& tolerances, ErrorTrace& trace)
      : Base(problem, t0, y0, t_end, tolerances), moved_(moved), trace_(trace), scale_(find_scale(trace)), t0_(t0) {
    for (int i = 0; i < W; ++i) error_[i] = flip() * compute_move(trace) * y0[i];
    measure(0.0);
    old_[0] = now_[0], old_[1] = now_[1];
  }

  /// Half a unit in the last place, as large as errors are carried.
  static double compute_move(const ErrorTrace& trace) {
    return find_scale(trace) * 0.5 * std::numeric_limits<double>::epsilon();
  }

  StepResult advance(double t_end) override {
    const StepResult result = Base::advance(t_end);
    if (result != StepResult::accepted) return result;
    carry_error();
    if (std::max(now_[0] / largest_, now_[1]) > trace_.most * trace_.asked) {
      trace_.given_up = std::abs(this->t_ - t0_);
      return StepResult::not_finite;
    }
    return result;
  }

  void interpolate_many(const double* times, std::size_t n, double* out) override {
    Base::interpolate_many(times, n, out);
    if (n == 0) return;
    trace_.moved = std::max({trace_.moved, old_[0], now_[0]});
    trace_.turned = std::max({trace_.turned, old_[1], now_[1]});
    if (trace_.moved > trace_.asked * largest_ || trace_.turned > trace_.asked) {
      trace_.parting = std::min(trace_.parting, good_);
    } else {
      good_ = std::abs(times[n - 1] - t0_);
    }
  }

 private:
  static double find_scale(const ErrorTrace& trace) { return std::max(1.0, 1e-6 / trace.asked); }

  /// Vigna's splitmix64 (public domain, as an idea): a fair coin that is the same on every machine.
  double flip() {
    coin_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = coin_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return ((z ^ (z >> 31)) & 1) != 0 ? 1.0 : -1.0;
  }

  void carry_error() {
    const int order = this->order_, terms = trace_.all_terms ? order : std::min(order - 1, few);
    const double* rows = this->rows_;
    const double s = ((this->time_.hi - this->time_old_.hi) + (this->time_.lo - this->time_old_.lo)) / this->unit_old_;
    alignas(64) double twin[W], arrived[W];
    for (int i = 0; i < W; ++i) twin[i] = this->y_old_[i] + error_[i];
    moved_.compute_series(this->time_old_, this->unit_old_, twin, twin, terms, twin_rows_);
    for (int k = W; k < W * (terms + 1); ++k) twin_rows_[k] -= rows[k];
    series_kernels().evaluate(twin_rows_, terms, Base::zero, error_, &s, 1, arrived);
    // As the largest of the last four terms tells it: one of them, or two, may happen to be small.
    double loss[W] = {}, sizes[3], power = scale_ * safety * shrink_ * std::pow(std::abs(s), order);
    for (int k = order; k > order - 4; --k, power *= shrink_ / std::abs(s)) {
      for (int i = 0; i < W; ++i) loss[i] = std::max(loss[i], std::abs(rows[W * k + i]) * power);
    }
    for (int i = 0; i < W; ++i) {
      loss[i] = std::copysign(loss[i], rows[W * order + i]);
      error_[i] = arrived[i] + loss[i];
    }
    this->problem_.measure_error(this->y_, loss, sizes);
    restore();
    old_[0] = now_[0], old_[1] = now_[1];
    measure(scale_ * rounding + aligned * find_part(sizes));
  }

  static double find_part(const double* sizes) {
    return std::max(sizes[0] > 0.0 ? sizes[1] / sizes[0] : 0.0, sizes[2]);
  }

  /// What y is brought back to after a step, its twin is brought back to as well.
  void restore() {
    double twin[W], low[W];
    for (int i = 0; i < W; ++i) {
      const math::DD sum = math::two_sum(this->y_[i], this->carry_[i] + error_[i]);
      twin[i] = sum.hi, low[i] = sum.lo;
    }
    this->problem_.correct(this->time_, this->counts_.steps - 1, twin, low);
    for (int i = 0; i < W; ++i) error_[i] = (twin[i] - this->y_[i]) + (low[i] - this->carry_[i]);
  }

  /// @param more  by how much of y the error grows in the direction that has grown so far: in any other it might by
  /// chance
  ///              not grow, and signs might cancel that do not cancel in truth
  void measure(double more) {
    double out[3];
    this->problem_.measure_error(this->y_, error_, out);
    largest_ = std::max(largest_, out[0]);
    const double part = find_part(out);
    if (part > 0.0 && part < std::numeric_limits<double>::infinity()) {
      const double factor = 1 + more / part;
      for (double& e : error_) e *= factor;
      out[1] *= factor, out[2] *= factor;
    }
    // An error that swings is small at times: it is held for a few steps.
    now_[0] = std::max(out[1] / scale_, 0.7 * now_[0]);
    now_[1] = std::max(out[2] / scale_, 0.7 * now_[1]);
    if (!(out[1] + out[2] < 1e300)) now_[0] = now_[1] = std::numeric_limits<double>::infinity();
  }

  const P& moved_;
  ErrorTrace& trace_;
  double scale_, t0_;
  double shrink_ =
      std::pow(this->tolerances_.rtol, 1.0 / (this->order_ - 1));   // of one term to the next, by the step's rule
  double largest_ = 0.0, now_[2] = {}, old_[2] = {}, good_ = 0.0;
  std::uint64_t coin_ = 2026;
  alignas(64) double error_[W] = {};
  alignas(64) double twin_rows_[W * (most_series_order + 1)] = {};
};

}  // namespace polhode::ode
