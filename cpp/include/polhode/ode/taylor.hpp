#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>

#include "polhode/math/detail/double_double.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/ode/method_record.hpp"
#include "polhode/ode/problem.hpp"
#include "polhode/ode/series.hpp"
#include "polhode/ode/stepper.hpp"
#include "polhode/ode/switched.hpp"

namespace polhode::ode {

/// A problem whose rows are wider than series_width: it has `width()` numbers, a multiple of eight, up to `most_width`,
/// and `count_blocks()` of its blocks are used.
template <class P>
concept WideProblem = requires(const P& problem) {
  { P::most_width } -> std::convertible_to<int>;
  { problem.width() } -> std::convertible_to<int>;
  { problem.count_blocks() } -> std::convertible_to<int>;
};

/// y' = f(t, y) whose Taylor coefficients are known by recurrences. A state is y, `dimension` <= series_width numbers
/// or those of a WideProblem, and `carry`, the rounding errors of y.
template <class P>
concept SeriesProblem =
    requires(const P& problem, math::DD t, double unit, const double* y, int order, long step, double* out) {
      /// Rows 0..order of the width's numbers: the coefficients of y(t + unit s) in powers of s.
      problem.compute_series(t, unit, y, y, order, out);
      /// Sizes of a row's blocks. Quantities with different units belong to different blocks.
      { P::blocks } -> std::convertible_to<int>;
      problem.compute_sizes(y, out);
      /// The number of leading coefficients that give a block's size: more than one if the block may start from zero.
      { P::heads[0] } -> std::convertible_to<int>;
      /// A time scale of the solution; only its order of magnitude matters.
      { problem.compute_time_scale(t, y) } -> std::convertible_to<double>;
      problem.start_carry(out);
      /// Restores known invariants of state and carry. Called after each step; steps are numbered from 0.
      problem.correct(t, step, out, out);
    };

/// Numbers of a row: known to the compiler for a body without further states.
template <SeriesProblem P>
constexpr int get_width(const P& problem) {
  if constexpr (WideProblem<P>) return problem.width();
  else return series_width;
}
template <SeriesProblem P>
constexpr int get_dimension(const P& problem) {
  if constexpr (WideProblem<P>) return problem.width();
  else return P::dimension;
}
template <SeriesProblem P>
constexpr int find_most_width() {
  if constexpr (WideProblem<P>) return P::most_width;
  else return series_width;
}

/// The Taylor series of the solution. Order and step follow Jorba & Zou 2005, Experimental Mathematics 14, 99, with
/// sizes by blocks. The state and the time are summed with compensation (Kahan) from step to step.
struct Taylor {
  static constexpr MethodRecord record{
      .name = "taylor",
      .order = most_series_order - 2,
      .dense_order = most_series_order - 2,
      .adaptive = true,
      .adaptive_order = true,
      .least_rtol = 1e-16,
      .keeps = "nothing",
      .needs = "torques of the library, not Custom",
      .doc =
          "Taylor series of the solution by recurrences. The tolerance sets order and step. Best at tight accuracies.",
      .source = "Jorba & Zou 2005, Exp. Math. 14, 99",
      // margin: a decade of tolerance costs a few per cent here, a second attempt two runs.
      .forecast = {.error_per_turn = 0.125,
                   .margin = 32.0,
                   .floor_per_turn = 2e-17,
                   .steps_per_radian = 0.62,
                   .power = 0.013,
                   .step_seconds = 3.5e-7,
                   .order_seconds = 1.1e-9,
                   .sample_seconds = 2e-8,
                   .stability = 8.5},
  };
  static constexpr int least_order = 4;

  /// The cheapest order is -ln(tolerance) if each row costs the same, and half of it if the cost of all rows grows as
  /// the square of their number. Loose tolerances, with few rows, are near the first case. Near the rounding error
  /// lower orders are better, because short steps round less.
  static int choose_order(double tolerance) {
    const double digits = -math::fast_log(tolerance), tight = std::clamp((digits - 18.0) / 18.0, 0.0, 1.0);
    const double order = std::ceil(1.0 + (1.0 - 0.46 * tight) * digits);   // NaN if the rates are beyond float64
    return order > least_order ? static_cast<int>(std::min(order, most_series_order - 2.0)) : least_order;
  }

  template <SeriesProblem P>
  class Stepper;
};

template <SeriesProblem P>
class Taylor::Stepper : public ode::Stepper {
  static constexpr int most_numbers = find_most_width<P>();

 public:
  Stepper(const P& problem, double t0, const double* y0, double t_end, const Tolerances& tolerances)
      : ode::Stepper(get_dimension(problem),
                     header + get_width(problem) * (choose_order(tolerances.rtol + tolerances.atol) + 2),
                     &evaluate_segment, t0),
        problem_(problem),
        tolerances_(tolerances),
        order_(choose_order(tolerances.rtol + tolerances.atol)),
        time_(t0) {
    part_ = compute_part(tolerances.rtol);
    for (int i = 0; i < 4; ++i) inverse_[i] = 1.0 / (order_ - 3 + i);
    std::copy_n(y0, get_dimension(problem), y_);
    problem.start_carry(carry_);
    unit_ = power_of_two(std::min(problem.compute_time_scale(time_, y_), std::abs(t_end - t0)));
  }

  const double* y() const override { return y_; }

  StepResult advance(double t_end) override {
    const double rest = (t_end - time_.hi) - time_.lo;
    double fraction = expand();
    for (int attempt = 0; !(fraction > 0.0) && attempt < 8; ++attempt) {
      unit_ *= 0x1p-16;
      fraction = expand();
    }
    if (!(fraction > 0.0)) return StepResult::not_finite;
    if constexpr (SwitchedProblem<P>) {
      if (const StepResult result = keep_mode(std::copysign(1.0, rest), fraction); result != StepResult::accepted)
        return result;
    }
    bool last = fraction * unit_ * 1.01 >= std::abs(rest);
    double s = last ? rest / unit_ : std::copysign(fraction, rest), h = s * unit_;
    if (!last && !(std::abs(h) > shortest())) return StepResult::underflow;

    const int W = width();
    if constexpr (SwitchedProblem<P>) {
      const double until = problem_.find_switch(time_, unit_, y_, carry_, rows_, order_, s);
      // The surface is here. A rest that is so short itself, between two ends of windows, is a step like others.
      if (std::abs(until * unit_) <= shortest() && (until != s || problem_.has_reached())) {
        if (!problem_.has_reached()) return StepResult::underflow;
        if (++idle_ > most_idle) return StepResult::chattering;
        return Stepper::advance(t_end);
      }
      idle_ = 0;
      if (until != s) last = false, s = until, h = s * unit_;
    }
    std::copy_n(y_, W, y_old_);
    std::copy_n(carry_, W, carry_old_);
    time_old_ = time_;
    unit_old_ = unit_;
    usable_ = fraction;
    arrive(s, last ? math::DD(t_end) : time_ + h);
    t_old_ = time_old_.hi;
    // A step shortened by t_end says little about the next one.
    unit_ = power_of_two(SwitchedProblem<P> ? std::min(fraction * unit_, std::abs(rest)) : fraction * unit_);
    ++counts_.steps;
    counts_.derivatives += order_;
    return StepResult::accepted;
  }

  /// Takes the last step again by the same series, to a later time. The state was not changed since.
  /// @return false if the tolerance does not allow so long a step
  bool extend(double t_end) {
    const double s = ((t_end - time_old_.hi) - time_old_.lo) / unit_old_;
    if (SwitchedProblem<P> || counts_.steps == 0 || !(std::abs(s) <= usable_)) return false;
    --counts_.steps;   // it is the same one
    arrive(s, math::DD(t_end));
    ++counts_.steps;
    return true;
  }

  void interpolate(double t, double* out) override { interpolate_many(&t, 1, out); }

  void interpolate_many(const double* times, std::size_t n, double* out) override {
    constexpr std::size_t at_once = 64;
    const double inverse = 1.0 / unit_old_;   // a power of two: nothing is rounded
    const int W = width(), size = get_dimension(problem_);
    double s[at_once];
    alignas(64) double rows[whole_rows ? 1 : series_width * at_once];
    for (std::size_t begin = 0; begin < n; begin += at_once) {
      const std::size_t count = std::min(at_once, n - begin);
      for (std::size_t i = 0; i < count; ++i) s[i] = ((times[begin + i] - time_old_.hi) - time_old_.lo) * inverse;
      if constexpr (whole_rows) {
        evaluate_series(rows_, order_, W, y_old_, carry_old_, s, count, out);
      } else {
        evaluate_series(rows_, order_, W, y_old_, carry_old_, s, count, rows);
        for (std::size_t i = 0; i < count; ++i)
          std::copy_n(rows + series_width * i, size, out + static_cast<std::size_t>(size) * i);
      }
      out += static_cast<std::size_t>(size) * count;
    }
  }

  const double* segment() override {
    const int W = width();
    segment_[0] = order_;
    segment_[1] = get_dimension(problem_);
    segment_[2] = (t_ - t_old_) / unit_old_;
    segment_[3] = -time_old_.lo / unit_old_;
    segment_[4] = W;
    std::copy_n(carry_old_, W, segment_.data() + header);
    std::copy_n(y_old_, W, segment_.data() + header + W);
    std::copy_n(rows_ + W, W * order_, segment_.data() + header + 2 * W);
    return segment_.data();
  }

  static void evaluate_segment(const double* segment, double fraction, double* out) {
    const double s = fraction * segment[2] + segment[3];
    const int W = static_cast<int>(segment[4]);
    const double *carry = segment + header, *rows = carry + W;
    double y[most_numbers];
    evaluate_series(rows, static_cast<int>(segment[0]), W, rows, carry, &s, 1, y);
    std::copy_n(y, static_cast<int>(segment[1]), out);
  }

  int width() const { return get_width(problem_); }

  /// The state and its rounding errors, which may be changed between two steps.
  double* state() { return y_; }
  double* carry() { return carry_; }

 protected:
  /// Takes the mode behind a surface that the last step has reached.
  StepResult switch_mode(double direction) {
    return problem_.switch_mode(time_, unit_, y_, std::min(order_, surface_order), direction,
                                [this](const Crossing& crossing) { this->cross(crossing); });
  }
  /// What a jump does to the errors that a stepper carries.
  virtual void cross(const Crossing&) {}
  static constexpr int surface_order = 6;   ///< of the series that decide a mode

 public:
  static constexpr int header = series_width;
  static constexpr double zero[most_numbers] = {};

 private:
  /// The end of a step from y_old_, in the unit of time unit_old_.
  void arrive(double s, math::DD time) {
    const int W = width();
    alignas(64) double increment[most_numbers];
    evaluate_series(rows_, order_, W, zero, carry_old_, &s, 1, increment);
    for (int i = 0; i < W; ++i) {
      const math::DD sum = math::two_sum(y_old_[i], increment[i]);
      y_[i] = sum.hi, carry_[i] = sum.lo;
    }
    time_ = time;
    std::copy_n(y_, W, arrived_);
    problem_.correct(time_, counts_.steps, y_, carry_);
    t_ = time_.hi;
  }

  static constexpr int most_idle = 8, most_switches = 100;

  /// Changes the mode until the series stays in it for a while.
  StepResult keep_mode(double direction, double& fraction)
    requires SwitchedProblem<P>
  {
    if (std::abs(time_.hi - counted_from_) > 10 * fraction * unit_) counted_from_ = time_.hi, switches_ = 0;
    for (int attempt = 0; problem_.leaves_mode(direction); ++attempt) {
      if (attempt > most_idle || ++switches_ > most_switches) return StepResult::chattering;
      if (const StepResult result = switch_mode(direction); result != StepResult::accepted) return result;
      fraction = expand();
      for (int shorter = 0; !(fraction > 0.25) && shorter < most_idle; ++shorter) {
        unit_ = fraction > 0.0 ? power_of_two(fraction * unit_) : unit_ * 0x1p-16;
        fraction = expand();
      }
      if (!(fraction > 0.0)) return StepResult::not_finite;
    }
    return StepResult::accepted;
  }

  /// Of a step that the time can tell.
  double shortest() const { return 8 * std::numeric_limits<double>::epsilon() * std::abs(time_.hi); }

  static constexpr bool whole_rows = [] {
    if constexpr (WideProblem<P>) return true;
    else return P::dimension == series_width;
  }();

  int count_blocks() const {
    if constexpr (WideProblem<P>) return problem_.count_blocks();
    else return P::blocks;
  }

  /// The largest power of two up to t. In this unit of time the coefficients neither overflow nor underflow.
  static double power_of_two(double t) { return math::power_of_two_below(std::clamp(t, 0x1p-900, 0x1p900)); }

  /// Computes the series and returns the step length in units of `unit_`. For each block the last two coefficients give
  /// the radius of convergence, and the tolerance gives the usable part of it. Returns infinity if the last
  /// coefficients vanish, and NaN if the series is not finite.
  double expand() {
    problem_.compute_series(time_, unit_, y_, carry_, order_ + further_, rows_);
    double size[5][P::blocks], sum = 0.0;
    const int row[5] = {0, 1, 2, order_ - 1, order_}, blocks = count_blocks();
    for (int k = 0; k < 5; ++k) {
      problem_.compute_sizes(rows_ + width() * row[k], size[k]);
      for (int b = 0; b < blocks; ++b) sum += size[k][b];
    }
    if (!(sum < std::numeric_limits<double>::infinity())) return std::numeric_limits<double>::quiet_NaN();
    double least = std::numeric_limits<double>::infinity();
    for (int b = 0; b < blocks; ++b) {
      RoughLog2 head[3];
      for (int j = 0; j < P::heads[b]; ++j) {
        head[j] = RoughLog2(size[j][b]);
        head[j].exponent = size[j][b] > 0.0 ? head[j].exponent : -10'000;
      }
      // the tolerance rtol size + atol, relative to the size
      const double part = tolerances_.atol == 0.0 || !(size[0][b] > 0.0)
                              ? part_
                              : compute_part(tolerances_.rtol + tolerances_.atol / size[0][b]);
      for (int m = 0; m < 2; ++m) {
        const double tail = size[3 + m][b];
        const RoughLog2 log_tail(tail);
        double radius = -std::numeric_limits<double>::infinity();
        for (int j = 0; j < P::heads[b]; ++j) radius = std::max(radius, (head[j] - log_tail) * inverse_[m + 2 - j]);
        least = tail > 0.0 ? std::min(least, radius + part) : least;
      }
    }
    if constexpr (requires { problem_.count_known(); })
      for (int b = 0; b < problem_.count_known(); ++b) least = std::min(least, limit_known(b));
    return least > 1000.0 ? std::numeric_limits<double>::infinity() : rough_exp2(least);
  }

  /// The same for a known function of time, which the problem's right side uses. It is in no norm of the state: its
  /// tolerance is relative to its own size.
  double limit_known(int b) const {
    double least = std::numeric_limits<double>::infinity();
    const RoughLog2 head(problem_.compute_known_size(0, b));
    for (int m = 0; m < 2; ++m) {
      const double tail = problem_.compute_known_size(order_ - 1 + m, b);
      if (tail > 0.0) least = std::min(least, (head - RoughLog2(tail)) * inverse_[m + 2] + part_);
    }
    return least;
  }

  double compute_part(double tolerance) const { return std::min((rough_log2(tolerance) - 2.0) / (order_ - 1), 0.0); }

 protected:
  const P& problem_;
  Tolerances tolerances_;
  int order_;
  double part_, inverse_[4];   ///< 1 / (order - 3), ..., 1 / order
  math::DD time_, time_old_;
  double unit_ = 1.0, unit_old_ = 1.0;
  double usable_ = 0.0;   ///< of the series of the last step, in its unit of time
  alignas(64) double y_[most_numbers] = {}, carry_[most_numbers] = {}, y_old_[most_numbers] = {}, carry_old_[most_numbers] = {};
  int further_ = 0;                      ///< rows after those of the order, which no step uses
  alignas(64) double arrived_[most_numbers] = {};   ///< the end of the last step, not corrected
  alignas(64) double rows_[most_numbers * (most_series_order + 1)] = {};

 private:
  int idle_ = 0, switches_ = 0;   ///< switches without a step; those since a time
  double counted_from_ = 0.0;
  std::array<double, header + most_numbers * (most_series_order + 2)> segment_ = {};
};

}  // namespace polhode::ode
