#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "polhode/ode/dense_output.hpp"
#include "polhode/ode/event.hpp"
#include "polhode/ode/stepper.hpp"

namespace polhode::ode {

enum class Ending { finished, event, max_steps, stopped, underflow, not_finite, no_solution };

struct DriveOptions {
  long max_steps = 10'000'000;
  bool dense = false;
  std::span<const Event> events = {};
  /// Called about twenty times a second with the time reached and the last time; false ends the run.
  std::function<bool(double reached, double last)> progress = {};
};

/// Takes the answers to some of the times, the first of them times[first]: rows of the stepper's dimension.
using Sink = std::function<void(std::size_t first, std::span<const double> times, const double* rows)>;

struct DriveResult {
  Ending ending = Ending::finished;
  double t = 0.0;                    ///< time reached
  std::size_t samples = 0;           ///< how many of the times were answered
  std::vector<EventHit> hits = {};
  DenseOutput dense = {};
};

/// Runs a stepper over `times`, which are sorted along the integration and lie on one side of the start, and hands the
/// samples to `sink` in their order. Knows nothing of how a step is made. At equal times every sample is handed out.
DriveResult drive(Stepper& stepper, std::span<const double> times, const Sink& sink, const DriveOptions& options);

}  // namespace polhode::ode
