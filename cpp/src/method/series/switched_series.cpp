#include "method/series/switched_series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "polhode/formula/modes.hpp"

namespace polhode {
namespace {

using formula::ActiveGuard;
using formula::Side;
using math::DD;

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double guard_rounding = 16 * eps;   // of a guard's largest part
constexpr double known_noise = 64.0;          // times an earlier one of a guard: it is not asked anew

std::shared_ptr<const formula::Program> make_system(const Scene& scene) {
  const BodySeries frame(drop_torques(scene), true);
  return std::make_shared<const formula::Program>(make_body_system(scene, frame, list_states(scene.torques())));
}

std::shared_ptr<const formula::Table> make_table(const formula::ModeProgram& mode) {
  const int rates = static_cast<int>(mode.program.outputs.size() - mode.guards.size());
  return std::make_shared<const formula::Table>(formula::Tape(mode.program, rates));
}

}  // namespace

bool has_switches(const Scene& scene) {
  return std::any_of(scene.torques().begin(), scene.torques().end(), [](const AnyTorque& torque) {
    const torques::Formula* formula = find_formula(torque);
    return formula != nullptr && formula->has_switches();
  });
}

SwitchedSeries::SwitchedSeries(const Scene& scene, bool)
    : system_(make_system(scene)),
      guards_(formula::list_sided_guards(*system_)),
      whole_(scene, make_table(formula::make_mode(*system_, Sides(guards_.forms.size(), Side::below)))),
      shared_(std::make_shared<Shared>()) {
  std::vector<double> states(start(), start() + width());
  states.erase(states.begin() + 3);   // the rates and the attitude have an octet
  formula::Program program = *system_;
  program.outputs = guards_.forms;
  std::vector<double> values(guards_.forms.size());
  formula::Evaluator evaluator(program);
  evaluator(scene.t0(), states.data(), nullptr, values.data());
  for (const double value : values) first_.push_back(value > 0.0 ? Side::above : Side::below);
  restart();
}

void SwitchedSeries::restart() const {
  shared_->sides = first_;
  shared_->reached = -1;
  shared_->near.clear(), shared_->on.clear(), shared_->last.clear();
  ++shared_->version;
}

double* SwitchedSeries::Mode::rows() {
  return align_to_line(guard_rows);
}

SwitchedSeries::Mode& SwitchedSeries::find_mode(const Sides& sides) const {
  std::shared_ptr<Mode>& found = modes_[sides];
  if (found) return *found;
  const formula::ModeProgram program = formula::make_mode(*system_, sides);
  const auto table = make_table(program);
  FormulaSeries series = whole_.with_table(table);
  if (choice_ != 0) series = series.perturbed(part_, choice_);
  found = std::make_shared<Mode>(Mode{std::move(series), program.guards, {}, {}, 0, {}, {}, {}});
  Mode& made = *found;
  made.guard_width = table->extra_width();
  made.guard_rows.resize(static_cast<std::size_t>(made.guard_width * (ode::most_series_order + 2) + 8));
  for (std::size_t i = 0; i < made.guards.size(); ++i) {
    const ActiveGuard& guard = made.guards[i];
    const bool above = guard.edge != Side::held || sides[static_cast<std::size_t>(guard.number)] == Side::above;
    made.directions.push_back(above ? 1.0 : -1.0);
    made.constants.push_back(std::abs(table->tape().extra_forms()[i].constant));
  }
  return made;
}

SwitchedSeries::Mode& SwitchedSeries::mode() const {
  if (version_ != shared_->version) mode_ = &find_mode(shared_->sides), version_ = shared_->version;
  return *mode_;
}

SwitchedSeries SwitchedSeries::perturbed(double part, int choice) const {
  SwitchedSeries other = *this;
  other.part_ = part, other.choice_ = choice;
  other.modes_.clear(), other.version_ = -1;
  return other;
}

SwitchedSeries SwitchedSeries::shifted(double t0, const double* error) const {
  SwitchedSeries other = *this;
  other.whole_ = whole_.shifted(t0, error);
  other.modes_.clear(), other.version_ = -1;
  return other;
}

void SwitchedSeries::expand(Mode& mode, DD t, double unit, const double* y, int order, double* rows) const {
  mode.series.expand(t, unit, y, order, rows, mode.guards.empty() ? nullptr : mode.rows());
  time_ = t, unit_ = unit, y_ = y;
}

const double* SwitchedSeries::find_noise(const Mode& of) const {
  Mode& mode = const_cast<Mode&>(of);
  const std::vector<double> key = {time_.hi, time_.lo, unit_};
  if (mode.noise_of == key) return mode.noise.data();
  mode.noise_of = key;
  const std::size_t count = static_cast<std::size_t>(mode.guard_width) * (noise_order + 1);
  const std::vector<double> kept = mode.guard_rows;
  const double* at_state = kept.data() + (mode.rows() - mode.guard_rows.data());
  alignas(64) double state[most_width], rows[most_width * (noise_order + 1)];
  std::copy_n(y_, width(), state);
  mode.noise.assign(count, 0.0);
  for (int i = 0; i < width(); ++i) {
    if (state[i] == 0.0) continue;
    constexpr double part = 0x1p-26;
    const double exact = std::exchange(state[i], state[i] * (1 + part));
    mode.series.expand(time_, unit_, state, noise_order, rows, mode.rows());
    for (std::size_t k = 0; k < count; ++k) mode.noise[k] += std::abs(mode.rows()[k] - at_state[k]) * (4 * eps / part);
    state[i] = exact;
  }
  mode.guard_rows = kept;
  return mode.noise.data();
}

int SwitchedSeries::count_zeros(const ActiveGuard& guard) const {
  int most = 0;
  if (guard.edge == Side::held && shared_->on_time.hi == time_.hi && shared_->on_time.lo == time_.lo)
    for (const On& one : shared_->on)
      if (one.number == guard.number) most = std::max(most, one.zeros);
  return most;
}

double SwitchedSeries::find_scale(const Mode& mode, DD t, double unit, const double* y) {
  return std::min(1.0, mode.series.compute_time_scale(t, y) / unit);
}

void SwitchedSeries::compute_series(DD t, double unit, const double* y, const double*, int order, double* rows) const {
  expand(mode(), t, unit, y, order, rows);
  order_ = order;
}

double SwitchedSeries::compute_guard(int guard, DD t, const double* y) const {
  alignas(64) double row[most_width];
  Mode& now = mode();
  double* values = now.rows() + now.guard_width * (ode::most_series_order + 1);
  now.series.expand(t, 1.0, y, 0, row, values);
  return values[guard];
}

double SwitchedSeries::list_coefficients(const Mode& mode, int guard, int order, double s, double* a) const {
  const double* rows = const_cast<Mode&>(mode).rows() + guard;
  double power = mode.directions[static_cast<std::size_t>(guard)];
  double size = mode.constants[static_cast<std::size_t>(guard)];
  for (int k = 0; k <= order; ++k, power *= s) {
    a[k] = rows[k * mode.guard_width] * power;
    size = std::max(size, std::abs(a[k]));
  }
  const double rounding = guard_rounding * size;
  const int zeros = std::min(count_zeros(mode.guards[static_cast<std::size_t>(guard)]), order + 1);
  std::fill_n(a, zeros, 0.0);
  if (std::all_of(a, a + order + 1, [](double x) { return x == 0.0; })) return rounding;
  if (mode.noise.empty()) find_noise(mode);
  if (a[0] > std::max(rounding, known_noise * mode.noise[static_cast<std::size_t>(guard)])) return rounding;
  // A guard next to its surface is on it; the first coefficient that is no rounding says where it goes.
  const double* noise = find_noise(mode) + guard;
  double least = rounding;
  power = 1.0;
  for (int k = 0; k <= order; ++k, power *= std::abs(s)) {
    if (k <= noise_order) least = std::max(least, noise[k * mode.guard_width] * power);
    if (std::abs(a[k]) > least) break;
    a[k] = 0.0;
  }
  return std::max(rounding, noise[0]);
}

std::vector<int> SwitchedSeries::list_left(const Mode& mode, int order, double direction) const {
  std::vector<int> left;
  double a[ode::most_series_order + 1];
  for (int i = 0; i < static_cast<int>(mode.guards.size()); ++i) {
    list_coefficients(mode, i, order, direction, a);
    int k = 0;
    while (k <= order && a[k] == 0.0) ++k;
    if (k <= order && a[k] < 0.0) left.push_back(i);
  }
  return left;
}

bool SwitchedSeries::leaves_mode(double direction) const {
  if (shared_->reached >= 0) return true;
  return !mode().guards.empty() && !list_left(mode(), std::min(order_, 6), direction).empty();
}

}  // namespace polhode
