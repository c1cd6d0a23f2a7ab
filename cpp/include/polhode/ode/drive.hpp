#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "polhode/ode/dense_output.hpp"
#include "polhode/ode/event.hpp"
#include "polhode/ode/stepper.hpp"

namespace polhode::ode {

/// `stalled`: many steps are rejected, and those that are taken stay a thousand times shorter than earlier ones, or the
/// rest would take more than `max_steps` of them.
enum class Ending {
  finished, event, max_steps, stalled, stopped, underflow, not_finite, no_solution, sliding, chattering
};

struct DriveOptions {
  long max_steps = 10'000'000;
  bool dense = false;
  std::span<const Event> events = {};
  /// Called at most twenty times a second with the time reached and the last time; false ends the run.
  std::function<bool(double reached, double last)> progress = {};
};

/// Receives samples: one row of the stepper's dimension for each of `times`, which begin with number `first` of all.
using Sink = std::function<void(std::size_t first, std::span<const double> times, const double* rows)>;

struct DriveResult {
  Ending ending = Ending::finished;
  double t = 0.0;                    ///< time reached
  std::size_t samples = 0;           ///< how many of the times were reached
  std::vector<EventHit> hits = {};
  DenseOutput dense = {};
};

/// Runs a stepper over `times` and passes the samples to `sink` in their order. The times are sorted along the
/// integration and lie on one side of the start. Equal times give a sample each.
DriveResult drive(Stepper& stepper, std::span<const double> times, const Sink& sink, const DriveOptions& options);

}  // namespace polhode::ode
