#include "method/series/switched_series.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "polhode/math/detail/functions.hpp"
#include "polhode/ode/first_root.hpp"

namespace polhode {
namespace {

constexpr double guard_tail = 1e-3;       // the last terms of its series, of a guard's size
constexpr double near_surface = 0x1p-6;   // of a guard's size: so small, the guard of the state is asked

}  // namespace

double SwitchedSeries::find_switch(math::DD t, double unit, const double* y, const double* carry, const double* rows,
                                   int order, double s) const {
  Mode& now = mode();
  double first = 2.0, a[ode::most_series_order + 1];
  shared_->reached = -1;
  shared_->near.clear();
  shared_->direction = std::copysign(1.0, s);
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
    // The step begins on a surface by chance.
    const formula::ActiveGuard& guard = now.guards[static_cast<std::size_t>(i)];
    if (a[0] == 0.0 && guard.edge == formula::Side::held && count_zeros(guard) == 0) shared_->near.push_back({i, 0.0});
    const double tail = std::abs(a[order]) + std::abs(a[order - 1]);
    // The guard of the state itself decides, because its series may be less accurate than the state.
    const auto value = [&](double u) {
      alignas(64) double state[most_width];
      const double at = u * s;
      ode::evaluate_series(rows, order, width(), y, carry, &at, 1, state);
      return now.directions[static_cast<std::size_t>(i)] * compute_guard(i, t + at * unit, state);
    };
    const double root = ode::find_first_root(a, order);
    double u = root > 1.0 ? 2.0 : ode::polish_root(value, a, order, root);
    if (u > 1.0) {
      const double lowest = ode::find_lowest(a, order, std::max(near_surface * size, 4 * tail));
      if (lowest > 1.0) continue;
      if (!(value(lowest) <= 0.0)) {
        if (lowest < 1.0) shared_->near.push_back({i, lowest * s});
        continue;
      }
      u = ode::polish_root(value, a, order, lowest);
    }
    if (u < first) first = u, shared_->reached = i;
  }
  if (shared_->reached < 0) return s;
  std::erase_if(shared_->near, [&](const Near& one) { return std::abs(one.s) >= std::abs(first * s); });
  return first * s;
}

void SwitchedSeries::pass_near(math::DD t, double unit, const double* y, const double* carry, const double* rows, int order,
                               const ode::NearSink& sink) const {
  alignas(64) double before[most_width * (ode::most_series_order + 1)];
  alignas(64) double behind[most_width * (ode::most_series_order + 1)];
  for (const Near& one : shared_->near) {
    alignas(64) double state[most_width];
    ode::evaluate_series(rows, order, width(), y, carry, &one.s, 1, state);
    Mode& now = mode();
    Mode& other = find_mode(flip(shared_->sides, now, {one.guard}));
    const math::DD at = t + one.s * unit;
    sink(at, state, measure(at, unit, state, noise_order, shared_->direction, now, one.guard, other, before, behind));
  }
}

}  // namespace polhode
