#pragma once

#include <concepts>

namespace polhode::ode {

/// y' = f(t, y) on a plain array of `dimension` numbers, and how its errors are measured.
template <class P>
concept Problem = requires(const P& problem, double t, const double* y, double* out) {
  { P::dimension } -> std::convertible_to<int>;
  problem.compute_derivative(t, y, out);
  /// |error| against the sizes of y at both ends of the step, in units of (atol + rtol size): 1 is just acceptable.
  { problem.error_norm(y, y, y, t, t) } -> std::convertible_to<double>;
  /// Restores known invariants of y (a unit quaternion), and adapts its derivative. Called after each accepted step.
  problem.restore(out, out);
};

/// The requested accuracy of a run, or its fixed step.
struct Tolerances {
  double rtol = 1e-9;
  double atol = 0.0;
  double step = 0.0;        ///< for methods with a fixed step
};

/// What a run cost.
struct Counts {
  long steps = 0;           ///< accepted
  long rejected = 0;
  long derivatives = 0;     ///< right-hand sides
  long events = 0;          ///< evaluations of event functions
  double seconds = 0.0;     ///< wall time of the whole run

  Counts& operator+=(const Counts& more) {
    steps += more.steps, rejected += more.rejected, derivatives += more.derivatives, events += more.events;
    seconds += more.seconds;
    return *this;
  }
};

}  // namespace polhode::ode
