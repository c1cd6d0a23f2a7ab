#pragma once

#include <array>
#include <memory>
#include <vector>

#include "derivative/column_equations.hpp"
#include "derivative/column_lanes.hpp"
#include "method/series/formula_series.hpp"

namespace polhode {

/// A FormulaSeries as an ode::WideProblem, with columns beside the state. They limit the step as the state does.
class FormulaColumns {
 public:
  static constexpr int most_width = FormulaSeries::most_width;
  static constexpr int blocks = FormulaSeries::blocks + 1;
  static constexpr std::array<int, blocks> heads = [] {
    std::array<int, blocks> heads{};
    heads.fill(3);
    heads[1] = 1;
    return heads;
  }();

  /// @param columns  at the start, (6 and the numbers of states, columns)
  FormulaColumns(const Scene& piece, std::shared_ptr<const ColumnEquations> equations, std::size_t count,
                 const std::vector<double>& columns);

  const FormulaSeries& body() const { return body_; }
  ColumnLanes& columns() const { return columns_; }

  int width() const { return body_.width(); }
  int count_blocks() const { return body_.count_blocks() + 1; }
  void compute_series(math::DD t, double unit, const double* y, const double* carry, int order, double* rows) const;
  void compute_sizes(const double* row, double* sizes) const;
  int count_known() const { return body_.count_known(); }
  double compute_known_size(int row, int which) const { return body_.compute_known_size(row, which); }
  double compute_time_scale(math::DD t, const double* y) const { return body_.compute_time_scale(t, y); }
  void start_carry(double* carry) const { body_.start_carry(carry); }
  void correct(math::DD t, long step, double* y, double* carry) const { body_.correct(t, step, y, carry); }

 private:
  FormulaSeries body_;
  std::shared_ptr<const ColumnEquations> equations_;
  const ColumnKernels& kernels_;
  // Of the last series, which the state's stepper asks for through a const problem.
  mutable ColumnLanes columns_;
  mutable std::vector<double> extras_;
  mutable const double* rows_ = nullptr;
  mutable double rate_ = 1.0;   ///< divides d omega where sizes are compared
};

}  // namespace polhode
