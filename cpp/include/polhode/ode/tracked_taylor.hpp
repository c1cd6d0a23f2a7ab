#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "polhode/math/detail/coin.hpp"
#include "polhode/ode/error_trace.hpp"
#include "polhode/ode/taylor.hpp"

namespace polhode::ode {

/// y' = f(t, y) with a measure of its errors.
template <class P>
concept TrackedProblem = SeriesProblem<P> && requires(const P& problem, const double* y, double* out) {
  /// For a state and a small error of it: the size of the first part, the error of the first part, the error of the
  /// second part as an angle, and that of the third part relative to its size.
  problem.measure_error(y, y, out);
};

/// Taylor steps that propagate estimates of their error.
///
/// `loss_` is the sum of what the steps have lost, with its signs: it cancels where the true losses cancel. The loss of
/// a step is the next terms of its series. They have the sign of the loss in each component and some per cent of error
/// (docs/notes/certificates.md).
/// `spread_` is what rounding may have made of the inputs and of each step, and a tenth of each loss. It starts from
/// perturbed inputs, follows perturbed constants, and grows in its own direction, so that it never cancels. Random kicks
/// by rounding are added, because its direction alone may be one that shrinks while others grow.
/// `sample_` is a second sample of rounding, by kicks and perturbed constants of its own: one of them may lie by chance
/// where little grows, but rarely both. At loose accuracies, where the loss is far larger, it is a part of `loss_`.
///
/// All are small and obey the equations linearised about y. So a few terms of their series suffice, which are the
/// differences of the series of y + scale e and of y. If the requested error is below 1e-6, `scale` enlarges it to
/// 1e-6. Where the error grows far beyond the requested one, the scale shrinks, so that the differences stay linear.
/// (Transport of local errors by the linearised equations: Hairer, Norsett & Wanner 1993, I.13 and II.8, for estimates
/// of the global error.)
template <TrackedProblem P>
class TrackedTaylor final : public Taylor::Stepper<P> {
  static constexpr int most_numbers = find_most_width<P>();
  static_assert(most_numbers <= most_series_width);
  static constexpr int error_terms = 12;        // with 7, a few parts in ten thousand are missing in each step
  static constexpr int signed_terms = 16;       // of the loss, which cancels, so that its parts must be more accurate
  static constexpr int loss_terms = 3;          // of the series after its order
  static constexpr double safety = 1.5;         // on the loss of a step
  static constexpr double unsigned_part = 0.1;  // of the loss, that the spread gets too
  static constexpr double rounding = 0x1p-53;   // of y in a step, whose sums are compensated
  static constexpr double kick = 0x1p-51;       // of y in a step, in any direction
  static constexpr double sample_kick = 0x1p-52;   // the same for the other sample
  static constexpr double certain = 4.0;   // times the error of a guard: beyond it, its side is certain
  // Relative, of the vectors. Invariants hold to their second order, which a vector made smaller has no more. The next
  // correction takes that part for an error of the first order, and near-singular bodies amplify it by thousands.
  static constexpr double most_enlarged = 1e-5;
  static constexpr double continuous = 1e-13;   // of a derivative: so small a jump at a surface is rounding
  static constexpr double least_enlarged = 0x1p-32;   // before it is made smaller by 2^-10
  static constexpr double least_angle = 0.25;     // of a step [rad]
  static constexpr double join_rounding = 0x1p-51;   // of a state that one run hands to the next
  using Base = Taylor::Stepper<P>;

 public:
  /// @param lost       the same problem with the invariants of the start plus trace.loss, and constants perturbed by
  ///                   trace.perturbation() unless the trace separates rounding
  /// @param perturbed  the same with those of the start plus trace.spread, and constants perturbed by as much in other
  ///                   directions; the starts are the problem's if the run continues none
  /// @param sampled    the same with trace.sample, if the trace separates rounding
  TrackedTaylor(const P& problem, const P& lost, const P& perturbed, const P& sampled, double t0, const double* y0,
                double t_end, const Tolerances& tolerances, ErrorTrace& trace)
      : Base(problem, t0, y0, t_end, tolerances),
        lost_(lost),
        perturbed_(perturbed),
        sampled_(sampled),
        trace_(trace),
        separate_(trace.separates_rounding()),
        t0_(t0) {
    this->further_ = std::min(loss_terms, most_series_order - this->order_);
    if (!trace.continued) trace.start(y0, this->width());
    const int W = this->width();
    std::copy_n(trace.loss, W, loss_);
    std::copy_n(trace.spread, W, spread_);
    std::copy_n(trace.sample, W, sample_);
    if (trace.continued) grow_spread(y0, trace_.scale * join_rounding);
    measure(y0);
    std::copy_n(now_, 3, old_);
  }

  StepResult advance(double t_end) override {
    t_end_ = t_end;
    const StepResult result = Base::advance(t_end);
    if (result != StepResult::accepted) return result;
    restarted_ = false, again_ = false;
    for (int k = 0; k < 3; ++k) std::copy_n(errors()[static_cast<std::size_t>(k)], this->width(), started_[k]);
    scale_ = trace_.scale;
    propagate_errors();
    if constexpr (SwitchedProblem<P>) pass_surfaces();
    if (find_largest_now() > trace_.most * trace_.asked) {
      trace_.given_up = trace_.before + std::abs(this->t_ - t0_);
      return StepResult::not_finite;
    }
    return result;
  }

  /// As Taylor::Stepper does, with the errors of the last step's start.
  bool extend(double t_end) {
    if (scale_ != trace_.scale || !Base::extend(t_end)) return false;
    for (int k = 0; k < 3; ++k) std::copy_n(started_[k], this->width(), errors()[static_cast<std::size_t>(k)]);
    again_ = true;
    propagate_errors();
    return find_largest_now() <= trace_.most * trace_.asked;
  }

  /// The errors, scaled by trace.scale, which may be changed with the state between two steps: the loss, the spread and
  /// the sample. restart() follows.
  std::array<double*, 3> errors() { return {loss_, spread_, sample_}; }
  /// Goes on from a state and errors that were changed.
  void restart() {
    const int W = this->width();
    now_[0] = now_[1] = now_[2] = 0.0;
    measure(this->y_);
    std::copy_n(loss_, W, trace_.loss);
    std::copy_n(spread_, W, trace_.spread);
    std::copy_n(sample_, W, trace_.sample);
    restarted_ = true;
  }
  /// Counts the state itself as a sample.
  void add_sample() { trace_.add(now_[0], now_[1], trace_.before + std::abs(this->t_ - t0_), now_[2]); }

  void interpolate_many(const double* times, std::size_t n, double* out) override {
    Base::interpolate_many(times, n, out);
    if (n == 0) return;
    trace_.add(std::max(old_[0], now_[0]), std::max(old_[1], now_[1]), trace_.before + std::abs(times[n - 1] - t0_),
               std::max(old_[2], now_[2]));
  }

 private:
  void propagate_errors() {
    const int W = this->width();
    const double s = ((this->time_.hi - this->time_old_.hi) + (this->time_.lo - this->time_old_.lo)) / this->unit_old_;
    // A body next to rest swings while it hardly rotates: errors of its rates may be small at both ends of a long step.
    double start[4], middle[3] = {};
    this->problem_.measure_error(this->y_old_, loss_, start);
    double* between = start[0] * std::abs(s * this->unit_old_) < least_angle ? middle : nullptr;
    propagate(lost_, 0, signed_terms, s, loss_, between);
    propagate(perturbed_, 1, error_terms, s, spread_, between);
    if (separate_) propagate(sampled_, 2, error_terms, s, sample_, between);
    alignas(64) double loss[most_numbers];
    double sizes[4];
    compute_loss(s, loss);
    for (int i = 0; i < W; ++i) loss_[i] += loss[i];
    this->problem_.measure_error(this->arrived_, loss, sizes);
    grow_spread(this->arrived_, trace_.scale * rounding + unsigned_part * find_relative_error(sizes));
    add_kicks(this->arrived_, separate_ ? sample_ : loss_);
    // Samples, and a run that continues this one, have the state before its correction.
    std::copy_n(now_, 3, old_);
    measure(this->arrived_);
    for (int k = 0; k < 3; ++k) now_[k] = std::max(now_[k], middle[k] / trace_.scale);
    std::copy_n(loss_, W, trace_.loss);
    std::copy_n(spread_, W, trace_.spread);
    std::copy_n(sample_, W, trace_.sample);
    if (find_largest_now() * trace_.scale > most_enlarged && outlasts_shrinking()) shrink();
    restore(lost_, loss_);
    restore(perturbed_, spread_);
    if (separate_) restore(sampled_, sample_);
  }

  /// Whether the vectors' part of the attitude, or of the vertical, is still seen in the state when they are made
  /// smaller. Next to rest it is tiny, while that of the rates is large beside them.
  bool outlasts_shrinking() const {
    double size = 0.0, largest = 0.0;
    for (int i = 4; i < 8; ++i) {
      size = std::max(size, std::abs(this->arrived_[i]));
      largest = std::max(largest, std::max(std::abs(loss_[i]), std::max(std::abs(spread_[i]), std::abs(sample_[i]))));
    }
    return largest >= least_enlarged * size;
  }

  /// A vector that grows beyond the linear range is made smaller.
  void shrink() {
    constexpr double part = 0x1p-10;
    trace_.scale *= part;
    for (double* error : {loss_, spread_, sample_, trace_.loss, trace_.spread, trace_.sample})
      for (int i = 0; i < this->width(); ++i) error[i] *= part;
  }

  /// A small error over the step, by the difference of two series.
  /// @param which    the vector's number
  /// @param between  gets the sizes in the middle of the step added, or null
  void propagate(const P& problem, int which, int most_terms, double s, double* error, double* between) {
    const int W = this->width(), terms = trace_.all_terms ? this->order_ : std::min(this->order_, most_terms);
    alignas(64) double propagated[most_numbers];
    double* const perturbed_rows = perturbed_rows_[which];
    if (!again_) {
      alignas(64) double perturbed[most_numbers] = {};
      for (int i = 0; i < W; ++i) perturbed[i] = this->y_old_[i] + error[i];
      problem.compute_series(this->time_old_, this->unit_old_, perturbed, perturbed, terms, perturbed_rows);
      for (int k = W; k < W * (terms + 1); ++k) perturbed_rows[k] -= this->rows_[k];
    }
    if (between != nullptr) {
      const double half = 0.5 * s;
      double sizes[4];
      evaluate_series(perturbed_rows, terms, W, Base::zero, error, &half, 1, propagated);
      this->problem_.measure_error(this->arrived_, propagated, sizes);
      for (int k = 0; k < 3; ++k) between[k] += sizes[k + 1];
    }
    evaluate_series(perturbed_rows, terms, W, Base::zero, error, &s, 1, propagated);
    std::copy_n(propagated, W, error);
  }

  /// The loss of the step in units of the scaled error: the first terms that the step leaves out.
  void compute_loss(double s, double* loss) {
    const int W = this->width();
    double power = trace_.scale * safety * math::power(s, this->order_);
    std::fill_n(loss, W, 0.0);
    for (int k = this->order_ + 1; k <= this->order_ + this->further_; ++k) {
      power *= s;
      for (int i = 0; i < W; ++i) loss[i] += power * this->rows_[W * k + i];
    }
  }

  /// The largest of the three errors, that of the first part relative to its size.
  static double find_relative_error(const double* sizes) {
    return std::max(std::max(sizes[0] > 0.0 ? sizes[1] / sizes[0] : 0.0, sizes[2]), sizes[3]);
  }
  double find_largest_now() const { return std::max(std::max(now_[0] / trace_.largest, now_[1]), now_[2]); }

  /// Applies the correction after a step to the erroneous solution as well.
  void restore(const P& problem, double* error) {
    const int W = this->width();
    double perturbed[most_numbers], low[most_numbers];
    for (int i = 0; i < W; ++i) {
      const math::DD sum = math::two_sum(this->y_[i], this->carry_[i] + error[i]);
      perturbed[i] = sum.hi, low[i] = sum.lo;
    }
    problem.correct(this->time_, this->counts_.steps - 1, perturbed, low);
    for (int i = 0; i < W; ++i) error[i] = (perturbed[i] - this->y_[i]) + (low[i] - this->carry_[i]);
  }

  /// @param growth  what to add to the spread, relative to y, in its own direction
  void grow_spread(const double* y, double growth) {
    double sizes[4];
    this->problem_.measure_error(y, spread_, sizes);
    const double relative = find_relative_error(sizes);
    if (!(relative > 0.0 && relative < std::numeric_limits<double>::infinity())) return;
    for (int i = 0; i < this->width(); ++i) spread_[i] *= 1 + growth / relative;
  }

  /// Changes each component of both samples by rounding, up or down at random, so that they get parts in every direction.
  void add_kicks(const double* y, double* other) {
    for (int i = 0; i < this->width(); ++i) {
      const double size = (coin_.toss() ? trace_.scale : -trace_.scale) * y[i];
      spread_[i] += kick * size, other[i] += ErrorTrace::unlike(i) * sample_kick * size;
    }
  }

  void measure(const double* y) {
    double lost[4], spread[4], sample[4];
    this->problem_.measure_error(y, loss_, lost);
    this->problem_.measure_error(y, spread_, spread);
    this->problem_.measure_error(y, sample_, sample);
    trace_.largest = std::max(trace_.largest, lost[0]);
    const double rates = lost[1] + spread[1] + sample[1], angle = lost[2] + spread[2] + sample[2];
    const double states = lost[3] + spread[3] + sample[3];
    // An oscillating error is small at times, so its size is held for a few steps.
    now_[0] = std::max(rates / trace_.scale, 0.7 * now_[0]);
    now_[1] = std::max(angle / trace_.scale, 0.7 * now_[1]);
    now_[2] = std::max(states / trace_.scale, 0.7 * now_[2]);
    if (!(rates + angle + states < 1e300)) now_[0] = now_[1] = std::numeric_limits<double>::infinity();
  }

  /// Samples up to the surface have the errors of either side, because a true motion may reach it sooner.
  void pass_surfaces() {
    this->problem_.pass_near(this->time_old_, this->unit_old_, this->y_old_, this->carry_old_, this->rows_, this->order_,
                             [this](math::DD t, const double* y, const Crossing& crossing) { miss(t, y, crossing); });
    if (this->problem_.has_reached()) this->switch_mode(std::copysign(1.0, t_end_ - t0_));
  }

  /// What the errors change in a guard at a state: of each one, and the sum of their sizes.
  double compare_guards(const Crossing& crossing, math::DD t, const double* y, double* parts) {
    double sum = 0.0;
    int i = 0;
    for (const auto& [problem, error] : {std::pair<const P*, const double*>{&lost_, loss_}, {&perturbed_, spread_},
                                         {&sampled_, sample_}}) {
      alignas(64) double perturbed[most_numbers] = {};
      for (int k = 0; k < this->width(); ++k) perturbed[k] = y[k] + error[k];
      parts[i] = error == sample_ && !separate_ ? 0.0 : problem->compute_guard(crossing.guard, t, perturbed) - crossing.value;
      sum += std::abs(parts[i++]);
    }
    return sum / trace_.scale;
  }

  /// The jump of the derivative at a surface; false if it is rounding.
  bool find_jump(const Crossing& crossing, const double* y, double* jump) {
    double sizes[4];
    for (int i = 0; i < this->width(); ++i) jump[i] = crossing.behind[i] - crossing.before[i];
    this->problem_.measure_error(y, jump, sizes);
    const double jumped = std::max({sizes[1], sizes[2], sizes[3]});
    this->problem_.measure_error(y, crossing.before, sizes);
    return jumped > continuous * std::max({sizes[1], sizes[2], sizes[3]});
  }

  /// How long a motion that comes as far as `depth` behind a surface may stay there, in units of time. It has the speed
  /// that depth allows, changed by the jump, and the bend behind the surface brings it back. Else it stays to the end.
  double find_stay(const Crossing& crossing, double depth) const {
    const double towards = std::max(crossing.outward, 0.0);
    const double speed = std::sqrt(towards * towards + 2 * crossing.curvature * depth) - towards + crossing.outward_behind;
    const double root = std::sqrt(speed * speed + 2 * crossing.bend * depth);
    const double end = std::abs(t_end_ - this->time_old_.hi) / this->unit_;
    const double stay = speed < 0.0 ? 2 * depth / (root - speed) : (speed + root) / crossing.bend;
    return stay < end ? stay : end;
  }

  void add_to_spread(const double* jump, double time, const double* y) {
    for (int i = 0; i < this->width(); ++i)
      spread_[i] += std::copysign(trace_.scale * std::abs(jump[i]) * time, spread_[i]);
    const double held[3] = {now_[0], now_[1], now_[2]};
    measure(y);
    for (int i = 0; i < 3; ++i) now_[i] = std::max(now_[i], held[i]);
    std::copy_n(loss_, this->width(), trace_.loss);
    std::copy_n(spread_, this->width(), trace_.spread);
    std::copy_n(sample_, this->width(), trace_.sample);
  }

  /// A surface that the step has not reached, but that an erroneous motion may.
  void miss(math::DD t, const double* y, const Crossing& crossing) {
    if constexpr (SwitchedProblem<P>) {
      constexpr double doubled = 2.0;   // the errors are those of the step's end
      alignas(64) double jump[most_numbers], parts[3];
      const double apart = doubled * compare_guards(crossing, t, y, parts) + crossing.rounding;
      // The lowest point of the guard's parabola, next to which the state is.
      const double above = 0.5 * crossing.slope * crossing.slope / crossing.curvature;
      if (std::abs(crossing.value) - above > apart || !(apart > 0.0) || !find_jump(crossing, y, jump)) return;
      add_to_spread(jump, find_stay(crossing, apart), this->arrived_);
    }
  }

  /// An error e of the state moves the crossing by -(e . grad g) / g', during which both sides' derivatives differ: the
  /// errors are multiplied by the saltation matrix 1 + (f_behind - f_before) grad g^T / g' (Leine & Nijmeijer 2004,
  /// Dynamics and Bifurcations of Non-Smooth Mechanical Systems, 7.3).
  void cross(const Crossing& crossing) override {
    if constexpr (SwitchedProblem<P>) {
      alignas(64) double jump[most_numbers], parts[3];
      const double slope = crossing.slope, scale = trace_.scale;
      const double apart = compare_guards(crossing, this->time_, this->y_, parts);
      // A changed state lies behind the surface, and no motion has crossed it.
      if (restarted_ && std::abs(crossing.value) > certain * (apart + crossing.rounding)) return;
      parts[0] += scale * crossing.value;
      const double D = apart + crossing.rounding, first = D / std::abs(slope);
      // Next to another crossing their order is in doubt, and the sides between them.
      const double end = std::abs(t_end_ - this->time_.hi) / this->unit_;
      const double late_now = first < end ? first : end, doubt = late_now + late_ / this->unit_;
      if (crossing.swapped != nullptr && crossing.since <= doubt) add_to_spread(crossing.swapped, doubt, this->y_);
      late_ = late_now * this->unit_;
      if (!find_jump(crossing, this->y_, jump)) return;
      const double bend = crossing.curvature * first / std::abs(slope);
      // At a small angle the crossing is not certain.
      if (!(bend < 0.5)) return add_to_spread(jump, find_stay(crossing, D), this->y_);
      double* const errors[3] = {loss_, spread_, sample_};
      for (int k = 0; k < (separate_ ? 3 : 2); ++k) {
        const double late = parts[k] / slope, unsure = scale * crossing.rounding / slope;
        for (int i = 0; i < this->width(); ++i) errors[k][i] += jump[i] * (late + std::copysign(unsure, late));
      }
      add_to_spread(jump, first * bend, this->y_);   // to second order
    }
  }

  const P &lost_, &perturbed_, &sampled_;
  ErrorTrace& trace_;
  const bool separate_;
  bool restarted_ = false;   ///< without a step since
  double t0_, t_end_ = 0.0;
  double late_ = 0.0;   ///< the doubt in the time of the last crossing
  double now_[3] = {}, old_[3] = {};
  math::Coin coin_;
  alignas(64) double loss_[most_numbers], spread_[most_numbers], sample_[most_numbers];
  bool again_ = false;           ///< the series of the last step are used once more
  double scale_ = 1.0;           ///< of the errors at its start
  double started_[3][most_numbers] = {};   ///< those errors
  alignas(64) double perturbed_rows_[3][most_numbers * (most_series_order + 1)] = {};
};

}  // namespace polhode::ode
