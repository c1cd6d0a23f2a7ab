#pragma once

#include <cmath>
#include <functional>
#include <vector>

namespace polhode::ode {

/// A function of the solution whose zeros are sought.
struct Event {
  std::function<double(double t, const double* y)> function;
  int direction = 0;       ///< +1: only where it rises along the integration, -1: only where it falls, 0: both
  bool terminal = false;   ///< the integration ends at the first zero
};

struct EventHit {
  int event;               ///< index of the event
  double t;
  std::vector<double> y;
};

/// Tracks the sign of one event function along the integration and finds each zero once.
class EventTracker {
 public:
  using Evaluate = std::function<void(double t, double* y)>;

  EventTracker(const Event& event, double t, const double* y) : event_(&event) {
    side_ = sign(event.function(t, y));
    t_ = t;
  }

  /// Searches the interval (previous time, t]; `evaluate(t, y)` gives the solution there. Returns true if it contains a
  /// zero of the event's direction, and sets `root`.
  bool crosses(double t, const double* y, const Evaluate& evaluate, long& count, double& root) {
    const double value = call(t, y, count);
    const int side = sign(value);
    const double start = t_;
    t_ = t;
    const int before = side_;
    side_ = side;   // 0 at an exact zero: it is found once, and a touch or a rest at zero is no other
    if (before == 0 || side == before) return false;
    root = side == 0 ? t : bisect(start, t, before, evaluate, count);
    const bool repeated = found_ && root == last_root_;
    found_ = true;
    last_root_ = root;
    return !repeated && (event_->direction == 0 || event_->direction == -before);
  }

 private:
  static int sign(double value) { return (value > 0) - (value < 0); }
  double call(double t, const double* y, long& count) {
    ++count;
    return event_->function(t, y);
  }

  /// The Illinois rule, with bisection when it stalls. It has no parameter and ends at neighbouring doubles. ITP
  /// (Oliveira & Takahashi 2021, ACM TOMS 47, 5) would save a few calls.
  double bisect(double a, double b, int side_a, const Evaluate& evaluate, long& count) {
    double y[64];
    evaluate(a, y);
    double fa = call(a, y, count);
    if (sign(fa) != side_a) fa = 0.0;         // rounding changed the sign at this end: bisect only
    evaluate(b, y);
    double fb = call(b, y, count);
    int stalled = 0;
    for (int i = 0; i < 200; ++i) {
      double m = 0.5 * (a + b);
      if (m == a || m == b) break;
      if (fa != 0.0 && fb != 0.0 && fa != fb && stalled < 3) {
        const double secant = b - fb * (b - a) / (fb - fa);
        if ((secant > a && secant < b) || (secant < a && secant > b)) m = secant;
      }
      evaluate(m, y);
      const double fm = call(m, y, count);
      if (fm == 0.0) return m;
      const double width = std::abs(b - a);
      if (sign(fm) == side_a) {
        a = m;
        fa = fm;
        if (fb != 0.0) fb *= 0.5;
      } else {
        b = m;
        fb = fm;
        if (fa != 0.0) fa *= 0.5;
      }
      stalled = std::abs(b - a) > 0.5 * width ? stalled + 1 : 0;
    }
    return b;
  }

  const Event* event_;
  int side_ = 0;
  double t_ = 0.0, last_root_ = 0.0;
  bool found_ = false;
};

}  // namespace polhode::ode
