#pragma once

#include <utility>
#include <vector>

#include "solve/proof/quadratic_system.hpp"
#include "solve/proof/taylor_step.hpp"

namespace polhode::proof {

/// A step of y' = c + L y + Q(y, y). Both defects are polynomials: their lower terms are rounding, their upper terms
/// what the series leave out, and sums of absolute values bound all of them. N(e) = Q(e, e).
class QuadraticStep final : public TaylorStep {
 public:
  QuadraticStep(QuadraticSystem system, const StepSettings& settings);

 private:
  void expand_state(const Interval& now) override;
  void expand_derivative() override;
  bool compute_defects(const std::vector<double>& box) override;
  void compute_jacobian() override;
  double compute_growth() const override;
  bool add_second_order(std::vector<double>& source) override;
  void prepare_pairs();

  const QuadraticSystem system_;
  double derivative_rounding_ = 0.0;
  std::vector<double> first_, second_;      ///< factors of the products, by powers
  struct SymmetricEntry {
    int i, j;
    double constant;                        ///< its largest value where i = j, else its size
    std::vector<std::pair<int, double>> factors;   ///< of the sizes of the variables
  };
  std::vector<SymmetricEntry> symmetric_;
};

}  // namespace polhode::proof
