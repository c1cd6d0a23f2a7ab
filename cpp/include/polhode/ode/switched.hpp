#pragma once

#include <functional>

#include "polhode/math/detail/double_double.hpp"
#include "polhode/ode/series.hpp"
#include "polhode/ode/stepper.hpp"

namespace polhode::ode {

/// A surface that the solution has reached, where its derivative jumps. Rates are in units of time of the step.
struct Crossing {
  int guard = 0;             ///< among those that act before the crossing
  double value = 0.0;        ///< of the guard at the state: what rounding left of 0
  double slope = 0.0;        ///< of the guard before the crossing
  double outward = 0.0;          ///< the speed towards the surface
  double outward_behind = 0.0;   ///< the speed away from it, behind it
  double curvature = 0.0;    ///< the largest second derivative of the guard, before or behind it
  double bend = 0.0;         ///< the second derivative behind it, where it brings the solution back; else 0
  double rounding = 0.0;     ///< of the guard's value
  /// By how much the jump would differ had the surface before been crossed after this one; null if there was none.
  const double* swapped = nullptr;
  double since = 0.0;               ///< time since the surface before
  const double* before = nullptr;   ///< y' before the surface and behind it
  const double* behind = nullptr;
};
using CrossingSink = std::function<void(const Crossing&)>;
/// Gets the time and the state as well.
using NearSink = std::function<void(math::DD t, const double* y, const Crossing&)>;

/// A series problem whose derivative jumps on surfaces of guards g(t, y) = 0. It is in one mode at a time, in which the
/// derivative is analytic. Copies of a problem share the mode.
template <class P>
concept SwitchedProblem = requires(const P& problem, math::DD t, double unit, const double* y, int order, double s,
                                   double direction, const CrossingSink& sink, const NearSink& near) {
  /// The part of s until the first surface, by the series that compute_series() has computed last; s without one.
  { problem.find_switch(t, unit, y, y, y, order, s) } -> std::convertible_to<double>;
  /// True if that series leaves its mode at once.
  { problem.leaves_mode(direction) } -> std::convertible_to<bool>;
  /// True if the last step has reached a surface.
  { problem.has_reached() } -> std::convertible_to<bool>;
  /// Takes the mode behind the surface.
  { problem.switch_mode(t, unit, y, order, direction, sink) } -> std::same_as<StepResult>;
  /// Shows surfaces that the last step, from this state and with these rows, has almost reached.
  problem.pass_near(t, unit, y, y, y, order, near);
  /// A guard of the mode at another state.
  { problem.compute_guard(order, t, y) } -> std::convertible_to<double>;
  problem.restart();
};

}  // namespace polhode::ode
