#include "method/series/switched_series.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace polhode {
namespace {

constexpr std::size_t most_open = 4;   // guards that change together

}  // namespace

SwitchedSeries::Sides SwitchedSeries::flip(const Sides& sides, const Mode& mode, const std::vector<int>& guards) const {
  Sides next = sides;
  for (const int i : guards) {
    const formula::ActiveGuard& guard = mode.guards[static_cast<std::size_t>(i)];
    formula::Side& side = next[static_cast<std::size_t>(guard.number)];
    side = guard.edge != formula::Side::held ? guard.edge : side == formula::Side::above ? formula::Side::below : formula::Side::above;
  }
  return next;
}

SwitchedSeries::Sides SwitchedSeries::choose_mode(math::DD t, double unit, const double* y, int order, double direction,
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
      next[static_cast<std::size_t>(number)] = next[static_cast<std::size_t>(number)] == formula::Side::above ? formula::Side::below : formula::Side::above;
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
      constexpr formula::Side list[] = {formula::Side::above, formula::Side::below, formula::Side::held};
      const formula::Side side = list[rest % 3];
      rest /= 3;
      possible = possible && (side != formula::Side::held || guards_.holds[static_cast<std::size_t>(number)]);
      sides[static_cast<std::size_t>(number)] = side;
    }
    if (!possible || sides == shared_->sides) continue;
    Mode& mode = find_mode(sides);
    expand(mode, t, unit, y, order, rows);
    if (list_left(mode, order, direction * find_scale(mode, t, unit, y)).empty()) return sides;
  }
  return {};
}

ode::Crossing SwitchedSeries::measure(math::DD t, double unit, const double* y, int order, double direction, Mode& mode,
                                      int guard, Mode& other, double* before, double* behind) const {
  expand(mode, t, unit, y, order, before);
  const double* rows = mode.rows() + guard;
  double a[ode::most_series_order + 1];
  ode::Crossing crossing{.guard = guard, .value = rows[0], .slope = rows[mode.guard_width],
                         .curvature = 2 * std::abs(rows[2 * mode.guard_width])};
  crossing.rounding = std::max(list_coefficients(mode, guard, order, 1.0, a), find_noise(mode)[guard]);
  const double side = mode.directions[static_cast<std::size_t>(guard)] * direction;
  crossing.outward = -side * crossing.slope;
  expand(other, t, unit, y, order, behind);
  for (std::size_t k = 0; k < other.guards.size(); ++k) {
    const formula::ActiveGuard& one = other.guards[k];
    if (one.number != mode.guards[static_cast<std::size_t>(guard)].number || one.edge != formula::Side::held) continue;
    const double* other_rows = other.rows() + k;
    const double bend = 2 * side * direction * other_rows[2 * other.guard_width];
    crossing.outward_behind = -side * other_rows[other.guard_width];
    crossing.curvature = std::max(crossing.curvature, std::abs(bend));
    crossing.bend = std::max(bend, 0.0);
  }
  crossing.before = before + width(), crossing.behind = behind + width();
  return crossing;
}

bool SwitchedSeries::compare_order(math::DD t, double unit, const double* y, const Sides& from, const Sides& to,
                                   std::size_t number, const ode::Crossing& crossing, double* change) const {
  const Sides& older = shared_->last;
  const auto holds = [](const Sides& sides) { return std::count(sides.begin(), sides.end(), formula::Side::held) > 0; };
  if (older.empty() || older == from || holds(older) || holds(to)) return false;
  Sides corner = older;
  corner[number] = to[number];
  if (corner == to || corner == older) return false;
  alignas(64) double rows[2 * most_width], others[2 * most_width];
  find_mode(corner).series.expand(t, unit, y, 1, rows, nullptr);
  find_mode(older).series.expand(t, unit, y, 1, others, nullptr);
  for (int i = 0; i < width(); ++i)
    change[i] = (crossing.behind[i] - crossing.before[i]) - (rows[width() + i] - others[width() + i]);
  return true;
}

ode::StepResult SwitchedSeries::switch_mode(math::DD t, double unit, const double* y, int order, double direction,
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
    // A guard that grazes its surface stays in its mode.
    list_coefficients(old, reached, order, direction * scale, a);
    if (old.guards[static_cast<std::size_t>(reached)].edge == formula::Side::held) a[0] = 0.0;
    const bool leaves = a[1] < 0.0 || (a[1] == 0.0 && a[2] < 0.0);
    if (leaves && std::find(left.begin(), left.end(), reached) == left.end()) left.push_back(reached);
  }
  if (reached >= 0) shared_->on.push_back({old.guards[static_cast<std::size_t>(reached)].number, 1});
  if (left.empty()) return ode::StepResult::accepted;
  const Sides from = shared_->sides;
  for (std::size_t i = 0; i < from.size(); ++i)
    if (from[i] == formula::Side::held) shared_->on.push_back({static_cast<int>(i), 1});
  if (left.size() == 1 && old.guards[static_cast<std::size_t>(left[0])].edge != formula::Side::held) {
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
    ode::Crossing crossing = measure(t, unit, y, order, direction, mode, i, find_mode(next), before, behind);
    alignas(64) double swapped[most_width];
    if (compare_order(t, unit, y, now, next, static_cast<std::size_t>(number), crossing, swapped)) {
      crossing.swapped = swapped;
      crossing.since = std::abs((t.hi - shared_->last_time.hi) + (t.lo - shared_->last_time.lo)) / unit;
    }
    sink(crossing);
    shared_->last = now, shared_->last_time = t;
    now = next;
  }
  shared_->sides = slides ? from : to, ++shared_->version;
  return slides ? ode::StepResult::sliding : ode::StepResult::accepted;
}

}  // namespace polhode
