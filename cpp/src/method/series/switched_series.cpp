#include "method/series/switched_series.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "polhode/formula/modes.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/ode/first_root.hpp"

namespace polhode {
namespace {

using formula::ActiveGuard;
using formula::Side;
using math::DD;

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double guard_rounding = 16 * eps;   // of a guard's largest part
constexpr double guard_tail = 1e-3;           // the last terms of its series, of a guard's size
constexpr double near_surface = 0x1p-6;       // of a guard's size: so small, the guard of the state is asked
constexpr std::size_t most_open = 4;          // guards that change together
constexpr int noise_order = 3;                // of the coefficients whose rounding is asked

/// Where a polynomial without a zero in (0, 1] is lowest, if it comes below a limit there; else 2. Not at 0 where it
/// begins at 0.
double find_lowest(const double* a, int degree, double limit) {
  const auto value = [&](double u) {
    double sum = a[degree];
    for (int k = degree; k-- > 0;) sum = sum * u + a[k];
    return sum;
  };
  double begin = 0.0;
  if (a[0] > limit) {
    double lowered[ode::most_series_order + 1];
    std::copy_n(a, degree + 1, lowered);
    lowered[0] -= limit;
    begin = ode::find_first_root(lowered, degree);
    if (begin > 1.0) return 2.0;
  }
  constexpr int parts = 32;
  const double width = (1.0 - begin) / parts;
  double values[parts + 1];
  for (int i = 0; i <= parts; ++i) values[i] = value(begin + i * width);
  int best = parts;
  for (int i = a[0] == 0.0 ? 1 : 0; i < parts; ++i)   // a guard may leave its surface
    if (values[i] < values[best] && (i == 0 || values[i] <= values[i - 1])) best = i;
  if (!(values[best] < limit)) return 2.0;
  if (best == 0 || best == parts) return best == 0 ? begin : 1.0;
  const double turn = values[best - 1] - 2 * values[best] + values[best + 1];
  return begin + (best + (turn > 0.0 ? 0.5 * (values[best - 1] - values[best + 1]) / turn : 0.0)) * width;
}

/// The zero of a falling function near a zero of its polynomial, by Newton's rule in a bracket: the first number found
/// where it is not positive.
template <class Value>
double polish(const Value& value, const double* a, int degree, double root) {
  constexpr int most = 60;
  double u = root, low = 0.0, high = 2.0, reach = 0x1p-50;
  for (int i = 0; i < most && high - low > 2 * eps * low; ++i) {
    const double now = value(u);
    (now > 0.0 ? low : high) = u;
    if (low >= 1.0) return 2.0;
    double slope = 0.0;
    for (int k = degree; k > 0; --k) slope = slope * u + k * a[k];
    const double step = slope < 0.0 ? -now / slope : 2.0;
    reach = std::max(4 * reach, 2 * std::abs(step));
    double next = u + step;
    // Next to the zero it steps over it, so that both ends of the bracket close in.
    if (high > 1.0) next = std::min(u + std::max(step, reach), 1.0);
    else if (low == 0.0) next = std::max(u - std::max(-step, reach), 0.0);
    else if (std::abs(step) < 2 * eps * u) next = now > 0.0 ? u + 2 * eps * u : u - 2 * eps * u;
    if (!(next > low && next < high)) next = high > 1.0 ? 1.0 : 0.5 * (low + high);
    u = next;
  }
  return high;
}

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
  shared_->near.clear(), shared_->on.clear();
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
  if (a[0] > rounding || std::all_of(a, a + order + 1, [](double x) { return x == 0.0; })) return rounding;
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

double SwitchedSeries::find_switch(DD t, double unit, const double* y, const double* carry, const double* rows,
                                   int order, double s) const {
  Mode& now = mode();
  double first = 2.0, a[ode::most_series_order + 1];
  shared_->reached = -1;
  shared_->near.clear();
  const int guards = static_cast<int>(now.guards.size());
  double part = 1.0;   // of the step, in which the series of all guards are accurate
  for (int i = 0; i < guards; ++i) {
    list_coefficients(now, i, order, s, a);
    double size = now.constants[static_cast<std::size_t>(i)];
    for (int k = 0; k < order - 1; ++k) size = std::max(size, std::abs(a[k]));
    const double tail = std::max(std::abs(a[order]), std::abs(a[order - 1]));
    if (tail > guard_tail * size) part = std::min(part, math::fast_pow(guard_tail * size / tail, 1.0 / (order - 1)));
  }
  s *= part;
  for (int i = 0; i < guards; ++i) {
    const double rounding = list_coefficients(now, i, order, s, a);
    double size = 0.0;
    for (int k = 0; k <= order; ++k) size = std::max(size, std::abs(a[k]));
    if (!(size > rounding)) continue;
    const double tail = std::abs(a[order]) + std::abs(a[order - 1]);
    // The guard of the state itself decides, because its series may be less accurate than the state.
    const auto value = [&](double u) {
      alignas(64) double state[most_width];
      const double at = u * s;
      ode::evaluate_series(rows, order, width(), y, carry, &at, 1, state);
      return now.directions[static_cast<std::size_t>(i)] * compute_guard(i, t + at * unit, state);
    };
    double root = ode::find_first_root(a, order);
    if (root > 1.0) {
      const double lowest = find_lowest(a, order, std::max(near_surface * size, 4 * tail));
      if (lowest > 1.0) continue;
      if (!(value(lowest) <= 0.0)) {
        if (lowest < 1.0) shared_->near.push_back({i, lowest * s});
        continue;
      }
      root = lowest;
    }
    const double u = polish(value, a, order, root);
    if (u < first) first = u, shared_->reached = i;
  }
  if (shared_->reached < 0) return s;
  std::erase_if(shared_->near, [&](const Near& one) { return std::abs(one.s) >= std::abs(first * s); });
  return first * s;
}

SwitchedSeries::Sides SwitchedSeries::flip(const Sides& sides, const Mode& mode, const std::vector<int>& guards) const {
  Sides next = sides;
  for (const int i : guards) {
    const ActiveGuard& guard = mode.guards[static_cast<std::size_t>(i)];
    Side& side = next[static_cast<std::size_t>(guard.number)];
    side = guard.edge != Side::held ? guard.edge : side == Side::above ? Side::below : Side::above;
  }
  return next;
}

SwitchedSeries::Sides SwitchedSeries::choose_mode(DD t, double unit, const double* y, int order, double direction,
                                                  const Mode& before, const std::vector<int>& left) const {
  alignas(64) double rows[most_width * (ode::most_series_order + 1)];
  std::vector<int> open;   // guards, by number, that may be on either side
  const auto add_open = [&](const Mode& mode, const std::vector<int>& more) {
    for (const int i : more) {
      const int number = mode.guards[static_cast<std::size_t>(i)].number;
      if (std::find(open.begin(), open.end(), number) == open.end()) open.push_back(number);
    }
  };
  add_open(before, left);
  Sides next = flip(shared_->sides, before, left);
  for (std::size_t attempt = 0; attempt < most_open; ++attempt) {
    Mode& mode = find_mode(next);
    expand(mode, t, unit, y, order, rows);
    const std::vector<int> bad = list_left(mode, order, direction * find_scale(mode, t, unit, y));
    if (bad.empty()) return next;
    add_open(mode, bad);
    bool is_new = false;
    for (const int i : bad) {
      const int number = mode.guards[static_cast<std::size_t>(i)].number;
      // a guard that another switch has moved
      if (next[static_cast<std::size_t>(number)] != shared_->sides[static_cast<std::size_t>(number)]) continue;
      is_new = true;
      next[static_cast<std::size_t>(number)] = next[static_cast<std::size_t>(number)] == Side::above ? Side::below : Side::above;
    }
    if (!is_new) break;
  }
  if (open.size() > most_open) return {};
  // All sides of the guards that are open, those that friction may hold last.
  std::size_t count = 1;
  for (std::size_t i = 0; i < open.size(); ++i) count *= 3;
  for (std::size_t choice = 0; choice < count; ++choice) {
    Sides sides = shared_->sides;
    bool possible = true;
    std::size_t rest = choice;
    for (const int number : open) {
      constexpr Side list[] = {Side::above, Side::below, Side::held};
      const Side side = list[rest % 3];
      rest /= 3;
      possible = possible && (side != Side::held || guards_.holds[static_cast<std::size_t>(number)]);
      sides[static_cast<std::size_t>(number)] = side;
    }
    if (!possible || sides == shared_->sides) continue;
    Mode& mode = find_mode(sides);
    expand(mode, t, unit, y, order, rows);
    if (list_left(mode, order, direction * find_scale(mode, t, unit, y)).empty()) return sides;
  }
  return {};
}

ode::Crossing SwitchedSeries::measure(DD t, double unit, const double* y, int order, Mode& mode, int guard, Mode& other,
                                      double* before, double* behind) const {
  expand(mode, t, unit, y, order, before);
  const double* rows = mode.rows() + guard;
  double a[ode::most_series_order + 1];
  ode::Crossing crossing{.guard = guard, .value = rows[0], .slope = rows[mode.guard_width],
                         .curvature = 2 * std::abs(rows[2 * mode.guard_width])};
  crossing.rounding = std::max(list_coefficients(mode, guard, order, 1.0, a), find_noise(mode)[guard]);
  const double side = mode.directions[static_cast<std::size_t>(guard)];
  expand(other, t, unit, y, order, behind);
  for (std::size_t k = 0; k < other.guards.size(); ++k) {
    const ActiveGuard& one = other.guards[k];
    if (one.number != mode.guards[static_cast<std::size_t>(guard)].number || one.edge != Side::held) continue;
    const double bend = 2 * side * other.rows()[2 * other.guard_width + static_cast<int>(k)];
    crossing.curvature = std::max(crossing.curvature, std::abs(bend));
    crossing.bend = std::max(bend, 0.0);
  }
  crossing.before = before + width(), crossing.behind = behind + width();
  return crossing;
}

void SwitchedSeries::pass_near(DD t, double unit, const double* y, const double* carry, const double* rows, int order,
                               const ode::NearSink& sink) const {
  alignas(64) double before[most_width * (ode::most_series_order + 1)];
  alignas(64) double behind[most_width * (ode::most_series_order + 1)];
  for (const Near& one : shared_->near) {
    alignas(64) double state[most_width];
    ode::evaluate_series(rows, order, width(), y, carry, &one.s, 1, state);
    Mode& now = mode();
    Mode& other = find_mode(flip(shared_->sides, now, {one.guard}));
    const DD at = t + one.s * unit;
    sink(at, state, measure(at, unit, state, noise_order, now, one.guard, other, before, behind));
  }
}

ode::StepResult SwitchedSeries::switch_mode(DD t, double unit, const double* y, int order, double direction,
                                            const ode::CrossingSink& sink) const {
  alignas(64) double before[most_width * (ode::most_series_order + 1)];
  alignas(64) double behind[most_width * (ode::most_series_order + 1)];
  Mode& old = mode();
  const double scale = find_scale(old, t, unit, y);
  expand(old, t, unit, y, order, before);
  std::vector<int> left = list_left(old, order, direction * scale);
  double a[ode::most_series_order + 1];
  const int reached = std::exchange(shared_->reached, -1);
  if (shared_->on_time.hi != t.hi || shared_->on_time.lo != t.lo) shared_->on.clear(), shared_->on_time = t;
  if (reached >= 0) {
    // A guard that turned on its surface stays in its mode.
    list_coefficients(old, reached, order, direction * scale, a);
    if (old.guards[static_cast<std::size_t>(reached)].edge == Side::held) a[0] = 0.0;
    const bool leaves = a[1] < 0.0 || (a[1] == 0.0 && a[2] < 0.0);
    if (leaves && std::find(left.begin(), left.end(), reached) == left.end()) left.push_back(reached);
  }
  if (reached >= 0) shared_->on.push_back({old.guards[static_cast<std::size_t>(reached)].number, 1});
  if (left.empty()) return ode::StepResult::accepted;
  const Sides from = shared_->sides;
  for (std::size_t i = 0; i < from.size(); ++i)
    if (from[i] == Side::held) shared_->on.push_back({static_cast<int>(i), 1});
  if (left.size() == 1 && old.guards[static_cast<std::size_t>(left[0])].edge != Side::held) {
    // Friction lets go: where no jump makes it do so, the share is 1, and the rate's derivative is 0.
    list_coefficients(old, left[0], order, direction * scale, a);
    if (left[0] == reached || a[0] == 0.0)
      shared_->on.push_back({old.guards[static_cast<std::size_t>(left[0])].number, 2});
  }
  const Sides to = choose_mode(t, unit, y, order, direction, old, left);
  const bool slides = to.empty();
  // One surface after the other, each with the jump that it makes.
  Sides now = from;
  const auto change_one = [&](int i, const Mode& mode) {
    const auto number = static_cast<std::size_t>(mode.guards[static_cast<std::size_t>(i)].number);
    if (slides) return flip(now, mode, {i});
    Sides next = now;
    next[number] = to[number];
    return next;
  };
  for (std::size_t n = 0; n < left.size(); ++n) {
    Mode& mode = find_mode(now);
    const int number = old.guards[static_cast<std::size_t>(left[n])].number;
    int i = -1;
    for (std::size_t k = 0; k < mode.guards.size(); ++k)
      if (mode.guards[k].number == number && (i < 0 || mode.guards[k].edge == old.guards[static_cast<std::size_t>(left[n])].edge))
        i = static_cast<int>(k);
    if (i < 0) continue;
    const Sides next = change_one(i, mode);
    shared_->sides = now, ++shared_->version;
    sink(measure(t, unit, y, order, mode, i, find_mode(next), before, behind));
    now = next;
  }
  shared_->sides = slides ? from : to, ++shared_->version;
  return slides ? ode::StepResult::sliding : ode::StepResult::accepted;
}

}  // namespace polhode
