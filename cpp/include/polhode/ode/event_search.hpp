#pragma once

#include <span>
#include <vector>

#include "polhode/ode/event.hpp"
#include "polhode/ode/stepper.hpp"

namespace polhode::ode {

/// The zeros of events in the steps of a run, in their order.
class EventSearch {
 public:
  /// What one step has: its zeros, up to the first terminal one, at which the run ends.
  struct Found {
    std::vector<EventHit> hits = {};
    bool ended = false;
    double t = 0.0;
  };

  /// @param events  which must live as long
  EventSearch(std::span<const Event> events, double t, const double* y);

  /// Searches the last step in a few pieces, so that two zeros within one step are both found.
  Found step(Stepper& stepper);
  /// Looks at a state at the end of the last step, where the state may have jumped.
  Found look(Stepper& stepper, double t, const double* y);

 private:
  std::span<const Event> events_;
  std::vector<EventTracker> trackers_;
};

}  // namespace polhode::ode
