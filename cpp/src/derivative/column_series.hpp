#pragma once

#include <vector>

#include "method/series/body_series.hpp"
#include "derivative/column_rows.hpp"
#include "derivative/column_terms.hpp"
#include "polhode/ode/taylor.hpp"

namespace polhode {

/// A body's series as an ode::SeriesProblem, with the columns of its variational equations beside the state. They are
/// expanded with each series of the state, and limit the step as the state does. A column has six numbers, d omega and
/// the small rotation R -> R exp([turn]x), in body axes.
class ColumnSeries {
 public:
  static constexpr int dimension = BodySeries::dimension;
  static constexpr int blocks = 3;
  static constexpr int heads[blocks] = {3, 1, 1};

  /// @param columns  at the start, as (6, columns)
  ColumnSeries(const Scene& piece, const std::vector<ColumnCause>& causes, const std::vector<double>& columns);

  const BodySeries& body() const { return body_; }
  std::size_t numbers() const { return 6 * count_; }   ///< of all columns

  void compute_series(math::DD t, double unit, const double* y, const double* carry, int order, double* rows) const;
  void compute_sizes(const double* row, double* sizes) const;
  double compute_time_scale(math::DD t, const double* y) const { return body_.compute_time_scale(t, y); }
  void start_carry(double* carry) const { body_.start_carry(carry); }
  void correct(math::DD t, long step, double* y, double* carry) const { body_.correct(t, step, y, carry); }

  /// Ends the step at s units of time of the last series.
  void advance(double s);
  /// The columns at n such times within the step, as (n, 6, columns).
  void evaluate(const double* s, std::size_t n, double* out) const;
  /// Those at the end of the step, as (6, columns).
  std::vector<double> columns() const;

 private:
  struct Sums {
    alignas(64) double high[6][8] = {}, low[6][8] = {};   ///< the columns, and the rounding errors of their sums
  };

  void see_vectors(math::DD t, double unit, const double* y, int order) const;
  void find_products(math::DD t, double unit, int order) const;
  void fill_matrix(int order) const;
  double measure(int row) const;
  VectorRows& source(ForceSource which) const { return sources_[static_cast<std::size_t>(which)]; }
  void to_body(std::size_t group, const double (*column)[8], double* out) const;

  BodySeries body_;
  ColumnTerms terms_;
  const ColumnKernels& kernels_;
  std::size_t count_;
  bool sees_space_[3] = {}, sees_orbit_ = false;
  std::vector<std::vector<ColumnForce>> forces_;   ///< of each eight columns
  std::vector<Sums> arrived_;                      ///< at the end of the last step
  // Of the last series, which the state's stepper asks for through a const problem.
  mutable std::vector<Sums> start_;
  mutable std::vector<ColumnRows> series_;
  mutable VectorRows sources_[static_cast<std::size_t>(ForceSource::count)] = {};
  mutable MatrixRow matrix_[ode::most_series_order + 2] = {};
  mutable VectorRows radius_ = {}, tangent_ = {};
  mutable const double* rows_ = nullptr;
  mutable int order_ = 0;
  mutable double rate_ = 1.0;   ///< divides d omega where sizes are compared
};

/// Taylor steps of the state, and of the columns with it.
class ColumnStepper final : public ode::Taylor::Stepper<ColumnSeries> {
  using Base = ode::Taylor::Stepper<ColumnSeries>;

 public:
  ColumnStepper(ColumnSeries& series, double t0, double t_end, const ode::Tolerances& tolerances)
      : Base(series, t0, series.body().start(), t_end, tolerances), series_(series) {}

  ode::StepResult advance(double t_end) override;
  /// The columns at times within the last step, as (n, 6, columns).
  void columns_at(const double* times, std::size_t n, double* out) const;

 private:
  ColumnSeries& series_;
};

}  // namespace polhode
