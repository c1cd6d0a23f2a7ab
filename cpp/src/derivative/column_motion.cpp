#include "derivative/column_motion.hpp"

#include <algorithm>
#include <utility>

#include "derivative/column_series.hpp"
#include "derivative/formula_columns.hpp"
#include "derivative/switched_columns.hpp"
#include "polhode/ode/taylor.hpp"

namespace polhode {
namespace {

/// Taylor steps of a state, and of the columns with it.
template <class Series>
class SeriesMotion final : public ColumnMotion {
 public:
  template <class... Given>
  SeriesMotion(double t0, double t_end, const ode::Tolerances& tolerances, Given&&... given)
      : series_(std::forward<Given>(given)...), stepper_(series_, t0, series_.body().start(), t_end, tolerances) {}

  double t() const override { return stepper_.t(); }
  ode::StepResult advance(double t_end) override {
    const ode::StepResult result = stepper_.advance(t_end);
    if (result == ode::StepResult::accepted) series_.columns().advance(stepper_.step());
    return result;
  }
  void sample(const double* times, std::size_t n, double* omega, double* attitude, double* columns) override {
    states_.resize(ode::most_series_width * n), places_.resize(n);
    stepper_.interpolate_many(times, n, states_.data());
    series_.body().unpack(states_.data(), n, omega, attitude);
    for (std::size_t i = 0; i < n; ++i) places_[i] = stepper_.place(times[i]);
    series_.columns().evaluate(places_.data(), n, columns);
  }
  void end(State& state, std::vector<double>& columns) const override {
    double attitude[4];
    series_.body().unpack(stepper_.y(), 1, state.omega.data(), attitude);
    state.attitude = {attitude[0], attitude[1], attitude[2], attitude[3]};
    std::copy_n(stepper_.y() + ode::series_width, state.states.size(), state.states.begin());
    state.t = stepper_.t();
    columns = series_.columns().columns();
  }
  void change(const Vector3d& jump, const std::vector<double>& states, const std::vector<double>& columns) override {
    double *y = stepper_.state(), *carry = stepper_.carry();
    if (!jump.isZero(0.0)) {
      double moved[ode::series_width] = {jump[0], jump[1], jump[2]};
      series_.body().pack_error(moved);
      for (int i = 0; i < 4; ++i) y[i] += moved[i];
    }
    for (std::size_t i = 0; i < states.size(); ++i) {
      if (y[ode::series_width + i] == states[i]) continue;
      y[ode::series_width + i] = states[i], carry[ode::series_width + i] = 0.0;
    }
    series_.columns().write(columns);
  }

 private:
  /// Times of the last step in units of its series.
  class Stepper final : public ode::Taylor::Stepper<Series> {
    using Base = ode::Taylor::Stepper<Series>;

   public:
    using Base::Base;
    double step() const {
      return ((this->time_.hi - this->time_old_.hi) + (this->time_.lo - this->time_old_.lo)) / this->unit_old_;
    }
    double place(double t) const { return ((t - this->time_old_.hi) - this->time_old_.lo) / this->unit_old_; }
  };

  Series series_;
  Stepper stepper_;
  std::vector<double> states_, places_;
};

}  // namespace

std::unique_ptr<ColumnMotion> make_column_motion(const Scene& piece, const std::vector<ColumnCause>& causes,
                                                 const std::vector<double>& columns, double t_end,
                                                 const ode::Tolerances& tolerances,
                                                 ModeEquations& equations) {
  if (!needs_formula_series(piece))
    return std::make_unique<SeriesMotion<ColumnSeries>>(piece.t0(), t_end, tolerances, piece, causes, columns);
  if (has_switches(piece)) {
    return std::make_unique<SeriesMotion<SwitchedColumns>>(piece.t0(), t_end, tolerances, piece, causes, equations,
                                                           columns);
  }
  return std::make_unique<SeriesMotion<FormulaColumns>>(piece.t0(), t_end, tolerances, piece,
                                                        find_equations(piece, causes, {}, equations), causes.size(),
                                                        columns);
}

}  // namespace polhode
