#pragma once

#include <span>
#include <vector>

#include "solve/proof/error_set.hpp"
#include "solve/proof/quadratic_system.hpp"

namespace polhode::proof {

using math::DD;

/// How finely steps are computed.
struct StepSettings {
  double tolerance = 1e-20;        ///< of what one step leaves out, relative to the rates and to 1
  double derivative_tolerance = 1e-7;   ///< of what one step leaves out of the motion's derivative
  double remainder_factor = 1.0;   ///< multiplies the bound on what is left out: anything below 1 is wrong, for tests
};

/// One step: a polynomial P about a computed state, a polynomial matrix F for the motion's derivative by that state,
/// and a bound on the rest.
///
/// With y' = f(y) = c + L y + Q(y, y), J(t) the Jacobian along P, and an exact start P(0) + e0, the exact motion is
///     y(t) = P(t) + F(t) e0 + r(t),    r' = J r + Q(e, e) - d - D e0,    e = F e0 + r,    r(0) = 0,
/// where d = P' - f(P) and D = F' - J F are the defects. Both are polynomials: their lower terms are rounding, their
/// upper terms what the series leave out, and sums of absolute values bound all of them. r then obeys two comparison
/// systems, by components and by Euclidean length; the smaller bound counts. The bound also shows that the exact motion
/// exists on the whole step.
class TaylorStep {
 public:
  TaylorStep(const QuadraticSystem& system, const StepSettings& settings);

  /// Expands about a state. @return the step length that the tolerance suggests
  double expand(std::span<const DD> state);

  /// Bounds the rest over [0, margin * length]. @return false where none was found: try a shorter one
  bool bound(double length, const ErrorSet& errors);

  /// Steps meet at times that are known within less than this part of their length: both hold what lies there.
  static constexpr double margin = 1.0 + 0x1p-30;

  /// Whether a time up to this one lies where bound(length, ...) holds.
  static bool is_bounded_at(double time, double length) { return time <= length * (1.0 + 0x1p-31); }

  /// P at a time that is_bounded_at() allows and that is known within `slack`; `lost` bounds the error of each component.
  void evaluate(DD time, double slack, std::vector<DD>& state, std::vector<double>& lost) const;

  /// F at a time that is known within `slack`, and in `lost` a bound on the error of F e0 within the bounded step.
  void evaluate_derivative(double time, double slack, std::vector<double>& F, std::vector<double>& lost) const;

  int width() const { return width_; }                            ///< of a row of F
  const std::vector<double>& rest() const { return rest_; }       ///< bounds |r_i|
  const std::vector<double>& spread() const { return spread_; }   ///< bounds |e_i| anywhere within the step
  double largest_rate() const { return largest_rate_; }           ///< so far, to which tolerances are relative
  void expect_rate(double rate) { largest_rate_ = rate; }

 private:
  void expand_state();
  void expand_derivative();
  void prepare_pairs();
  double* F(int k, int row) { return &derivative_[to_index((k * n_ + row) * width_)]; }
  const double* F(int k, int row) const { return &derivative_[to_index((k * n_ + row) * width_)]; }
  double* P(int variable) { return &high_[to_index(variable * (order_ + 1))]; }
  const double* P(int variable) const { return &high_[to_index(variable * (order_ + 1))]; }
  double sum_from(int variable, int k) const {
    return k > order_ ? 0.0 : tails_[to_index(variable * (order_ + 1) + std::max(k, 0))];
  }
  void compute_sizes(double length);
  void compute_defects(const std::vector<double>& box);
  double compute_growth() const;
  void compare_by_components(double length, double rate_unit, const std::vector<double>& source,
                             std::vector<double>& result) const;

  /// Of a sum of at most 2^8 products of double-doubles, relative to their sizes.
  static constexpr double fine_rounding = 0x1p-93;

  const QuadraticSystem& system_;
  StepSettings settings_;
  int n_, width_, order_, fine_, derivative_order_ = 0, next_derivative_order_;
  double rounding_, derivative_rounding_;
  std::vector<double> high_, low_;          ///< coefficients of P; `low_` of the first fine_ + 1
  std::vector<double> derivative_;          ///< coefficients of F
  std::vector<double> first_, second_;      ///< factors of the products, by powers
  std::vector<double> powers_, sizes_, tails_;   ///< of the length; |P_k| length^k; their sums from k on
  std::vector<double> images_;              ///< |F_k| box length^k by powers and variables
  std::vector<double> defect_, rest_, spread_, jacobian_;
  struct SymmetricEntry {
    int i, j;
    double constant;                        ///< its largest value where i = j, else its size
    std::vector<std::pair<int, double>> factors;   ///< of the sizes of the variables
  };
  std::vector<SymmetricEntry> symmetric_;
  double largest_rate_ = 0.0;
};

}  // namespace polhode::proof
