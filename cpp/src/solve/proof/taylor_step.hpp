#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "polhode/math/detail/interval.hpp"
#include "solve/proof/error_set.hpp"
#include "solve/proof/index.hpp"

namespace polhode::proof {

using math::DD;
using math::Interval;

/// How finely steps are computed.
struct StepSettings {
  double tolerance = 1e-20;        ///< of what one step leaves out, relative to the rates and to 1
  double derivative_tolerance = 1e-7;   ///< of what one step leaves out of the motion's derivative
  double switch_factor = 1.0;      ///< multiplies the widths of guards and of jumps: anything below 1 is wrong, for tests
  double remainder_factor = 1.0;   ///< multiplies the bound on what is left out: anything below 1 is wrong, for tests
};

/// One step: a polynomial P about a computed state, a polynomial matrix F for the motion's derivative by that state,
/// and a bound on the rest.
///
/// With y' = f(t, y), J(t) the Jacobian along P, and an exact start P(0) + e0, the exact motion is
///     y(t) = P(t) + F(t) e0 + r(t),    r' = J r + N(e) - d - D e0,    e = F e0 + r,    r(0) = 0,
/// where d = P' - f(P) and D = F' - J F are the defects and N(e) = f(P + e) - f(P) - J e is of second order. r then
/// obeys two comparison systems, by components and by Euclidean length; the smaller bound counts. The bound also shows
/// that the exact motion exists on the whole step. What f is decides how P, F and the bounds on d, D, J and N are made.
class TaylorStep {
 public:
  virtual ~TaylorStep() = default;

  /// Expands about a state. @param now  the time since the start in the units of the equations, along the run
  /// @return the step length that the tolerance suggests
  double expand(std::span<const DD> state, const Interval& now);

  /// Bounds the rest over [0, margin * length]. @return false where none was found: try a shorter one
  bool bound(double length, const ErrorSet& errors);

  /// Steps meet at times that are known within less than this part of their length: both hold what lies there.
  static constexpr double margin = 1.0 + 0x1p-30;

  /// Whether a time up to this one lies where bound(length, ...) holds.
  static bool is_bounded_at(double time, double length) { return time <= length * (1.0 + 0x1p-31); }

  /// P at a time that is_bounded_at() allows and that is known within `slack`; `lost` bounds the error of each
  /// component.
  void evaluate(DD time, double slack, std::vector<DD>& state, std::vector<double>& lost) const;

  /// F at a time that is known within `slack`, and in `lost` a bound on the error of F e0 within the bounded step.
  void evaluate_derivative(double time, double slack, std::vector<double>& F, std::vector<double>& lost) const;

  int width() const { return width_; }                            ///< of a row of F
  const std::vector<double>& rest() const { return rest_; }       ///< bounds |r_i|
  const std::vector<double>& spread() const { return spread_; }   ///< bounds |e_i| anywhere within the step
  /// At least |y_i - P_i(0)| anywhere within the bounded step.
  double reach(int variable) const { return raised(sum_from(variable, 1) + spread_[to_index(variable)]); }
  double largest_rate() const { return largest_size(0); }
  /// The largest size of a variable so far, to which tolerances are relative: that of all rates, at least 1 of others.
  double largest_size(int variable) const { return largest_[to_index(variable)]; }
  const std::vector<double>& largest_sizes() const { return largest_; }
  void expect_sizes(const std::vector<double>& sizes) { largest_ = sizes; }

 protected:
  /// @param first_own  the variables from here on have units of their own, and sizes beside 1
  TaylorStep(int size, const StepSettings& settings, int first_own);

  /// Rounding to nearest of one coefficient, relative to the sizes of its parts: it decides how many have low halves.
  void set_rounding(double rounding);

  /// The coefficients of P and of F after the first.
  virtual void expand_state(const Interval& now) = 0;
  virtual void expand_derivative() = 0;
  /// A length up to the given one within the tolerance of what else the step follows.
  virtual double shorten(double length) const { return length; }
  /// `defect_`: |d| + |D| box over the step, by components. @return false where f is not known to be analytic
  virtual bool compute_defects(const std::vector<double>& box) = 0;
  /// `jacobian_`: A_ij >= |J_ij| and A_ii >= max(0, J_ii) along P.
  virtual void compute_jacobian() = 0;
  /// At least the Euclidean logarithmic norm of J anywhere on the step.
  virtual double compute_growth() const = 0;
  /// Adds |N(e)| for all |e_i| <= spread_i. @return false where f is not known to be analytic
  virtual bool add_second_order(std::vector<double>& source) = 0;

  double* F(int k, int row) { return &derivative_[to_index((k * n_ + row) * width_)]; }
  const double* F(int k, int row) const { return &derivative_[to_index((k * n_ + row) * width_)]; }
  double* P(int variable) { return &high_[to_index(variable * (order_ + 1))]; }
  const double* P(int variable) const { return &high_[to_index(variable * (order_ + 1))]; }
  double sum_from(int variable, int k) const {
    return k > order_ ? 0.0 : tails_[to_index(variable * (order_ + 1) + std::max(k, 0))];
  }
  /// |F_k| box length^k
  double image(int k, int variable) const { return images_[to_index(k * n_ + variable)]; }

  /// Of a sum of at most 2^8 products of double-doubles, relative to their sizes.
  static constexpr double fine_rounding = 0x1p-93;
  static constexpr double unit = 0x1p-53;

  StepSettings settings_;
  int n_, width_, order_, fine_ = 1, derivative_order_ = 0, next_derivative_order_;
  double rounding_ = 0.0;
  std::vector<double> high_, low_;          ///< coefficients of P; `low_` of the first fine_ + 1
  std::vector<double> derivative_;          ///< coefficients of F
  std::vector<double> powers_, sizes_, tails_;   ///< of the length; |P_k| length^k; their sums from k on
  std::vector<double> defect_, rest_, spread_, jacobian_;

 private:
  void compute_sizes(double length);
  void compute_images(const std::vector<double>& box);
  void compare_by_components(double length, double rate_unit, const std::vector<double>& source,
                             std::vector<double>& result) const;

  std::vector<double> images_, largest_;
  int first_own_;
};

}  // namespace polhode::proof
