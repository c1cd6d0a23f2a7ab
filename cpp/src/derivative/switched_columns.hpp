#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "derivative/column_equations.hpp"
#include "derivative/column_lanes.hpp"
#include "method/series/switched_series.hpp"

namespace polhode {

/// A SwitchedSeries as an ode::SwitchedProblem, with columns beside the state. Where the motion crosses a surface g = 0
/// the columns jump by (f+ - f-) dg / g', of the rates f on both sides. They limit the step as the state does.
class SwitchedColumns {
 public:
  static constexpr int most_width = SwitchedSeries::most_width;
  static constexpr int blocks = SwitchedSeries::blocks + 1;
  static constexpr std::array<int, blocks> heads = [] {
    std::array<int, blocks> heads{};
    heads.fill(3);
    heads[1] = 1;
    return heads;
  }();

  /// @param known    the equations of modes, which must live as long
  /// @param columns  at the start, (6 and the numbers of states, columns)
  SwitchedColumns(const Scene& piece, const std::vector<ColumnCause>& causes, ModeEquations& known,
                  const std::vector<double>& columns);

  const SwitchedSeries& body() const { return body_; }
  ColumnLanes& columns() const { return columns_; }

  int width() const { return body_.width(); }
  int count_blocks() const { return body_.count_blocks() + 1; }
  void compute_series(math::DD t, double unit, const double* y, const double* carry, int order, double* rows) const;
  void compute_sizes(const double* row, double* sizes) const;
  double compute_time_scale(math::DD t, const double* y) const { return body_.compute_time_scale(t, y); }
  void start_carry(double* carry) const { body_.start_carry(carry); }
  void correct(math::DD t, long step, double* y, double* carry) const { body_.correct(t, step, y, carry); }

  double find_switch(math::DD t, double unit, const double* y, const double* carry, const double* rows, int order,
                     double s) const {
    return body_.find_switch(t, unit, y, carry, rows, order, s);
  }
  bool has_reached() const { return body_.has_reached(); }
  bool leaves_mode(double direction) const { return body_.leaves_mode(direction); }
  ode::StepResult switch_mode(math::DD t, double unit, const double* y, int order, double direction,
                              const ode::CrossingSink& sink) const;
  void pass_near(math::DD t, double unit, const double* y, const double* carry, const double* rows, int order,
                 const ode::NearSink& sink) const {
    body_.pass_near(t, unit, y, carry, rows, order, sink);
  }
  double compute_guard(int guard, math::DD t, const double* y) const { return body_.compute_guard(guard, t, y); }
  void restart() const { body_.restart(); }

 private:
  struct Mode {
    std::shared_ptr<const ColumnEquations> equations;
    FormulaSeries series;
    std::vector<double> rows, extras;
  };

  Mode& find_mode() const;
  /// Takes from the columns what friction that holds leaves of them.
  void project(const Mode& mode, const double* extras) const;
  void jump(math::DD t, double unit, const double* y, const ode::Crossing& crossing) const;

  Scene piece_;
  std::vector<ColumnCause> causes_;
  ModeEquations& known_;
  SwitchedSeries body_;
  const ColumnKernels& kernels_;
  mutable std::map<std::vector<formula::Side>, Mode> modes_;
  mutable ColumnLanes columns_;
  mutable std::optional<std::vector<formula::Side>> projected_;   ///< the mode whose friction they keep to
  mutable std::vector<double> earlier_;   ///< by so much each column moves the last crossing [s]
  mutable std::optional<math::DD> crossed_;   ///< its time
  mutable const double* rows_ = nullptr;
  mutable double rate_ = 1.0;   ///< divides d omega where sizes are compared
};

}  // namespace polhode
