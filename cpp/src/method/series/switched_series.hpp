#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "method/series/formula_series.hpp"
#include "polhode/formula/sides.hpp"
#include "polhode/ode/switched.hpp"

namespace polhode {

/// Whether a scene has a formula with switches.
bool has_switches(const Scene& scene);

/// A body under formulas with switches, as an ode::SwitchedProblem: a FormulaSeries for each mode that occurs.
///
/// switch_search.cpp finds where a step meets a surface, switch_modes.cpp the mode behind it.
class SwitchedSeries {
 public:
  static constexpr int most_width = FormulaSeries::most_width;
  static constexpr int blocks = FormulaSeries::blocks;
  static constexpr auto heads = FormulaSeries::heads;

  explicit SwitchedSeries(const Scene& scene, bool attitude = true);

  int width() const { return whole_.width(); }
  int count_blocks() const { return whole_.count_blocks(); }
  int count_states() const { return whole_.count_states(); }
  const double* start() const { return whole_.start(); }
  std::string describe_state() const { return whole_.describe_state(); }
  void unpack(const double* rows, std::size_t n, double* omega, double* attitude) const {
    whole_.unpack(rows, n, omega, attitude);
  }
  void pack_error(double* error) const { whole_.pack_error(error); }
  void unpack_error(double* error) const { whole_.unpack_error(error); }
  SwitchedSeries perturbed(double part, int choice) const;
  SwitchedSeries shifted(double t0, const double* error) const;
  void measure_error(const double* y, const double* error, double* out) const { whole_.measure_error(y, error, out); }
  void compute_series(math::DD t, double unit, const double* y, const double* carry, int order, double* rows) const;
  void compute_sizes(const double* row, double* sizes) const { whole_.compute_sizes(row, sizes); }
  int count_known() const { return mode().series.count_known(); }
  double compute_known_size(int row, int which) const { return mode().series.compute_known_size(row, which); }
  double compute_time_scale(math::DD t, const double* y) const { return mode().series.compute_time_scale(t, y); }
  void start_carry(double* carry) const { whole_.start_carry(carry); }
  void correct(math::DD t, long step, double* y, double* carry) const { whole_.correct(t, step, y, carry); }

  double find_switch(math::DD t, double unit, const double* y, const double* carry, const double* rows, int order,
                     double s) const;
  bool has_reached() const { return shared_->reached >= 0; }
  void pass_near(math::DD t, double unit, const double* y, const double* carry, const double* rows, int order,
                 const ode::NearSink& sink) const;
  bool leaves_mode(double direction) const;
  ode::StepResult switch_mode(math::DD t, double unit, const double* y, int order, double direction,
                              const ode::CrossingSink& sink) const;
  double compute_guard(int guard, math::DD t, const double* y) const;
  /// The mode of the start.
  void restart() const;

  const FormulaSeries& whole() const { return whole_; }
  /// The mode, and a guard of it as a number among all.
  const std::vector<formula::Side>& sides() const { return shared_->sides; }
  int number_of(int guard) const { return mode().guards[static_cast<std::size_t>(guard)].number; }
  /// Whether a guard is where friction that holds lets go.
  bool lets_go(int guard) const { return mode().guards[static_cast<std::size_t>(guard)].edge != formula::Side::held; }

 private:
  using Sides = std::vector<formula::Side>;
  static constexpr int noise_order = 3;   ///< of the coefficients whose rounding is asked

  struct Mode {
    FormulaSeries series;
    std::vector<formula::ActiveGuard> guards;
    std::vector<double> directions, constants;   ///< of each guard: its sign in the mode, and the size of its constant
    int guard_width = 0;
    std::vector<double> guard_rows;   ///< and one row for values
    std::vector<double> noise, noise_of;   ///< see find_noise(), and the time and its unit
    double* rows();   ///< aligned to 64 bytes
  };
  /// A guard that a step brings close to 0, and the step's part there.
  struct Near {
    int guard;
    double s;
  };
  /// A guard whose first coefficients are 0 by definition: 1 on its surface, 2 where friction has held it just before.
  struct On {
    int number, zeros;
  };
  /// Of a problem and its copies.
  struct Shared {
    Sides sides;
    int version = 0;
    int reached = -1;   ///< the guard whose surface the last step has reached
    std::vector<On> on;
    math::DD on_time = {};   ///< of `on`
    std::vector<formula::Side> last;   ///< sides before the last surface that was crossed
    math::DD last_time = {};
    std::vector<Near> near;   ///< of the last step, and its direction
    double direction = 1.0;
  };

  Mode& mode() const;
  Mode& find_mode(const Sides& sides) const;
  /// Coefficients of a guard in powers of a step in the direction of the run, positive within the mode, those below
  /// rounding being 0. Returns the rounding.
  double list_coefficients(const Mode& mode, int guard, int order, double s, double* a) const;
  /// Guards that a series leaves at once.
  std::vector<int> list_left(const Mode& mode, int order, double direction) const;
  void expand(Mode& mode, math::DD t, double unit, const double* y, int order, double* rows) const;
  /// A step of which a mode's series can tell the first coefficients, in units of time.
  static double find_scale(const Mode& mode, math::DD t, double unit, const double* y);
  /// What rounding of the state makes of the first coefficients of all guards, at the last expansion, of this mode.
  const double* find_noise(const Mode& mode) const;
  int count_zeros(const formula::ActiveGuard& guard) const;
  /// Both sides of a surface at a state; both rows stay in use.
  ode::Crossing measure(math::DD t, double unit, const double* y, int order, double direction, Mode& mode, int guard,
                        Mode& other, double* before, double* behind) const;
  /// Of the jump at a surface, what differs had the one before been crossed after it; false if none was.
  bool compare_order(math::DD t, double unit, const double* y, const Sides& from, const Sides& to, std::size_t number,
                     const ode::Crossing& crossing, double* change) const;
  Sides flip(const Sides& sides, const Mode& mode, const std::vector<int>& guards) const;
  /// A mode that the motion keeps behind a surface; empty if there is none.
  Sides choose_mode(math::DD t, double unit, const double* y, int order, double direction, const Mode& before,
                    const std::vector<int>& left) const;

  std::shared_ptr<const formula::Program> system_;   ///< with its switches
  formula::Guards guards_;
  FormulaSeries whole_;
  Sides first_;
  std::shared_ptr<Shared> shared_;
  double part_ = 0.0;
  int choice_ = 0;   ///< 0: constants are not perturbed
  mutable std::map<Sides, std::shared_ptr<Mode>> modes_;
  mutable Mode* mode_ = nullptr;
  mutable int version_ = -1, order_ = 0;
  mutable math::DD time_ = {};   ///< of the last expansion, with its unit of time and its state
  mutable double unit_ = 1.0;
  mutable const double* y_ = nullptr;
};

}  // namespace polhode
