#pragma once

#include <vector>

#include "derivative/column_lanes.hpp"
#include "derivative/column_terms.hpp"
#include "method/series/body_series.hpp"

namespace polhode {

/// A body's series as an ode::SeriesProblem, with the columns of its variational equations beside the state. They are
/// expanded with each series of the state, and limit the step as the state does. A column has six numbers, d omega and
/// the small rotation R -> R exp([theta]x), in body axes.
class ColumnSeries {
 public:
  static constexpr int dimension = BodySeries::dimension;
  static constexpr int blocks = 3;
  static constexpr int heads[blocks] = {3, 1, 1};

  /// @param columns  at the start, as (6, columns)
  ColumnSeries(const Scene& piece, const std::vector<ColumnCause>& causes, const std::vector<double>& columns);

  const BodySeries& body() const { return body_; }
  ColumnLanes& columns() const { return columns_; }

  void compute_series(math::DD t, double unit, const double* y, const double* carry, int order, double* rows) const;
  void compute_sizes(const double* row, double* sizes) const;
  double compute_time_scale(math::DD t, const double* y) const { return body_.compute_time_scale(t, y); }
  void start_carry(double* carry) const { body_.start_carry(carry); }
  void correct(math::DD t, long step, double* y, double* carry) const { body_.correct(t, step, y, carry); }

 private:
  void see_vectors(math::DD t, double unit, const double* y, int order) const;
  void find_products(math::DD t, double unit, int order) const;
  void fill_matrix(int order) const;
  VectorRows& source(ForceSource which) const { return sources_[static_cast<std::size_t>(which)]; }

  BodySeries body_;
  ColumnTerms terms_;
  const ColumnKernels& kernels_;
  bool sees_space_[3] = {}, sees_orbit_ = false;
  std::vector<std::vector<ColumnForce>> forces_;   ///< of each eight columns
  // Of the last series, which the state's stepper asks for through a const problem.
  mutable ColumnLanes columns_;
  mutable VectorRows sources_[static_cast<std::size_t>(ForceSource::count)] = {};
  mutable MatrixRow matrix_[ode::most_series_order + 2] = {};
  mutable VectorRows radius_ = {}, tangent_ = {};
  mutable const double* rows_ = nullptr;
  mutable double rate_ = 1.0;   ///< divides d omega where sizes are compared
};

}  // namespace polhode
