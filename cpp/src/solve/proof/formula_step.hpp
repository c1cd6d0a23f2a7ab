#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "polhode/formula/graph.hpp"
#include "solve/proof/formula_system.hpp"
#include "solve/proof/taylor_step.hpp"

namespace polhode::proof {

/// A step of y' = f(t, y) for an f of formulas.
///
/// Each operation of f gets a polynomial Z in time by its recurrence, rounded as it comes, and then a bound on |z - Z|
/// over the step, where z is the operation along P. The bound is by the defect of the equation that defines z: A - Z B
/// for a / b, A - Z^2 for a root, Z' - Z A' for e^a. Such a defect is a polynomial whose lower terms are rounding and
/// whose upper terms are left out. So are Taylor models in one variable: Makino & Berz 2003, Int. J. Pure Appl. Math.
/// 4, 379. N(e) is bounded by the second coefficient of f(P + s e) in s.
class FormulaStep final : public TaylorStep {
 public:
  FormulaStep(const FormulaSystem& system, const StepSettings& settings);

  int count_guards() const { return static_cast<int>(guards_.size()); }
  /// How long all guards have the signs `sides` for certain, from the begin of the bounded step on: at least this. 0
  /// where one has no sign there, infinity where all have theirs throughout.
  double find_certain(const std::vector<double>& sides, double length) const;
  /// A length in which a guard's series passes 0, about: of the first that may; 0 where none does.
  double find_crossing() const;

 private:
  enum class Kind {
    fixed, state, time, linear, scale, multiply, divide, root, exponential, logarithm, sine, cosine, tanh,
    slope,      ///< 1 - z^2 of the tanh before it
    squares,    ///< a^2 + b^2 for the angle behind it
    angle
  };
  struct Form {
    Interval constant = {};
    std::vector<std::pair<double, int>> terms = {};   ///< exact factors and slots
  };
  struct Slot {
    Kind kind;
    int a = -1, b = -1;                         ///< operands
    Form form = {};                             ///< of what is linear
    Interval value = {};                        ///< of what is fixed, or the factor of a scale
    bool is_full = true;                        ///< f needs it; else only its derivative does
  };
  struct Range {
    double least, most;                         ///< of |z|
  };
  /// Bounds on derivatives of an operation by its operands.
  struct Slopes {
    double a = 0.0, b = 0.0, aa = 0.0, ab = 0.0, bb = 0.0;
    bool known = true;
  };
  struct Entry {
    int row, column;
    Form form;
    std::vector<double> coefficients;           ///< of J_ij
    double size = 0.0;                          ///< bounds the polynomial
    double lost = 0.0;                          ///< bounds |J_ij - its polynomial|
  };

  void expand_state(const Interval& now) override;
  void expand_derivative() override;
  bool compute_defects(const std::vector<double>& box) override;
  void compute_jacobian() override;
  double compute_growth() const override;
  bool add_second_order(std::vector<double>& source) override;
  double shorten(double length) const override;

  int rows_of(const Slot& slot) const { return slot.is_full ? order_ : derivative_order_; }
  std::size_t at(int slot, int k) const { return to_index(slot * (order_ + 1) + k); }
  template <class N>
  N get(int slot, int k) const;
  template <class N>
  N compute(int slot, int k);
  void start(int slot);
  template <class N>
  N sum(const Form& form, int k) const;

  struct Sizes {
    double all = 0.0, coarse = 0.0, left_out = 0.0;
    Sizes& operator+=(const Sizes& other) {
      all += other.all, coarse += other.coarse, left_out += other.left_out;
      return *this;
    }
  };
  Sizes of_slot(int slot, const Slot& whole, bool weighted = false) const;
  Sizes of_pair(int first, int second, const Slot& whole, bool weighted = false) const;
  double lose(const Sizes& sizes) const;
  void measure_slot(int slot);
  bool bound_slot(int slot);
  double find_own_error(int slot) const;
  Range find_range(int slot, double wide) const;
  double tail(int slot, int k, bool weighted = false) const {
    return k > order_ ? 0.0 : (weighted ? weighted_tails_ : slot_tails_)[at(slot, std::max(k, 0))];
  }
  double lose_form(const Form& form, const Slot& whole) const;
  Slopes find_slopes(int slot, const std::vector<double>& wide) const;

  struct Guard {
    Form form;
    std::vector<double> coefficients = {};      ///< of its polynomial, and the low half of the first
    double low = 0.0;
  };
  /// At least |g(y) - its polynomial| on the bounded step.
  double find_width(const Guard& guard) const;
  double find_certain(const Guard& guard, double side, double length) const;

  std::vector<Slot> slots_;
  std::vector<Guard> guards_;
  std::vector<Form> rates_;                     ///< f
  std::vector<Entry> entries_;                  ///< of J that are not 0
  double t0_, per_time_, time_radius_ = 0.0;
  std::vector<double> slot_high_, slot_low_;    ///< coefficients by slots
  std::vector<double> start_;                   ///< radii of what functions start from
  std::vector<double> slot_sizes_, slot_tails_, weighted_sizes_, weighted_tails_;
  std::vector<double> lost_;                    ///< |z - Z| by slots
  std::vector<double> first_, second_;          ///< of N(e), by slots
  double derivative_rounding_ = 0.0;
  int refused_ = 0;                             ///< lengths of this step that lost too much
};

}  // namespace polhode::proof
