#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "method/series/body_series.hpp"
#include "polhode/formula/table.hpp"
#include "polhode/ode/series.hpp"

namespace polhode {

/// Whether a scene has a torque that only formula::Table expands.
bool needs_formula_series(const Scene& scene);

/// The same scene without torques.
Scene drop_torques(const Scene& scene);

/// Where numbers of memory begin at a boundary of 64 bytes, of which eight numbers are kept free.
double* align_to_line(std::vector<double>& numbers);

/// Euler's equations in the variables of a frame, with the torques as accelerations there.
/// @param states  those of the torques
formula::Program make_body_system(const Scene& scene, const BodySeries& frame,
                                  const std::vector<formula::Input>& states);

/// A body under torques that are formulas, as an ode::WideProblem. The equations of the whole body are one table, in the
/// variables of a BodySeries without torques: rates in principal axes or separatrix variables, and q_WP. The states of
/// the formulas follow, eight numbers a row's octet.
class FormulaSeries {
 public:
  static constexpr int most_width = ode::most_series_width;
  static constexpr int blocks = 2 + most_width - ode::series_width;
  static constexpr std::array<int, blocks> heads = [] {
    std::array<int, blocks> heads{};
    heads.fill(3);
    heads[1] = 1;
    return heads;
  }();

  /// @param attitude  is integrated in any case
  explicit FormulaSeries(const Scene& scene, bool attitude = true);
  /// @param table  of make_body_system()
  FormulaSeries(const Scene& scene, std::shared_ptr<const formula::Table> table);

  /// The same body with other recurrences for its rates, as those of one mode of its switches.
  FormulaSeries with_table(std::shared_ptr<const formula::Table> table) const;

  const BodySeries& frame() const { return frame_; }
  int width() const { return table_->width(); }
  int count_blocks() const { return 2 + static_cast<int>(ends_.size()); }
  const double* start() const { return start_.data(); }
  int count_states() const { return ends_.empty() ? 0 : ends_.back() - ode::series_width; }
  std::string describe_state() const;

  /// w_B and q_WB of n rows.
  void unpack(const double* rows, std::size_t n, double* omega, double* attitude) const;
  void pack_error(double* error) const { frame_.pack_error(error); }
  void unpack_error(double* error) const { frame_.unpack_error(error); }

  /// A copy with each constant of the table changed by twice this part of it, up or down by a rule for each choice.
  /// Equal constants change as one. 0 and powers of two, which are structure, stay. A body whose axes are rounded gets
  /// eight times as much.
  FormulaSeries perturbed(double part, int choice) const;
  /// A copy that starts from another state: this one plus an error.
  FormulaSeries shifted(double t0, const double* error) const;
  /// As BodySeries does; the error of a state is relative to its largest size in the run so far.
  void measure_error(const double* y, const double* error, double* out) const;

  void compute_series(math::DD t, double unit, const double* y, const double*, int order, double* rows) const {
    expand(t, unit, y, order, rows, nullptr);
  }
  /// The same with the rows of the table's extras, aligned to 64 bytes, or null.
  void expand(math::DD t, double unit, const double* y, int order, double* rows, double* extras) const;
  void compute_sizes(const double* row, double* sizes) const;
  /// Known functions of time in the torques, such as orbits, and their sizes in a row of the last expansion.
  int count_known() const { return table_->count_known(); }
  double compute_known_size(int row, int which) const;
  double compute_time_scale(math::DD t, const double* y) const;
  void start_carry(double* carry) const;
  void correct(math::DD t, long step, double* y, double* carry) const;

 private:
  BodySeries frame_;
  std::vector<formula::Input> states_;
  std::vector<int> ends_;          ///< columns behind each of them
  std::vector<bool> counted_;      ///< whether its error is one of the samples: not that of a command
  mutable std::vector<double> largest_;   ///< size of each of them so far
  std::vector<double> start_;
  std::shared_ptr<const formula::Table> table_;
  mutable std::vector<double> workspace_;   ///< of one run at a time
};

}  // namespace polhode
