#include "polhode/ode/drive.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>

#include "polhode/ode/event_search.hpp"

namespace polhode::ode {
namespace {

/// Calls back at most every twentieth of a second, and reads the clock only every 16 steps.
class Heartbeat {
 public:
  explicit Heartbeat(const std::function<bool(double, double)>& progress) : progress_(progress) {}

  bool stop_requested(double reached, double last) {
    if (!progress_ || (++calls_ & 15) != 0) return false;
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::milliseconds(50)) return false;
    last_ = now;
    return !progress_(reached, last);
  }

 private:
  const std::function<bool(double, double)>& progress_;
  unsigned calls_ = 0;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Sees in blocks of steps that a run makes no progress. Next to jumps of the rates steps become short, and many are
/// rejected. A smooth motion that needs many steps has few rejected ones, and a table with kinks has longer ones too.
class Pace {
 public:
  Pace(const Stepper& stepper, double last, long max_steps)
      : stepper_(stepper), last_(last), end_(stepper.counts().steps + max_steps), t_(stepper.t()) {
    start_block();
  }

  bool stalled() {
    longest_ = std::max(longest_, std::abs(stepper_.t() - stepper_.t_old()));
    const Counts& now = stepper_.counts();
    if (now.steps - steps_ < block) return false;
    const double step = std::abs(stepper_.t() - t_) / block, rest = std::abs(last_ - stepper_.t());
    const bool stalled = now.rejected - rejected_ > block / 3 &&
                         (step < longest_ / 1000 || rest > step * static_cast<double>(end_ - now.steps));
    start_block();
    return stalled;
  }

 private:
  static constexpr long block = 8192;

  void start_block() {
    t_ = stepper_.t();
    steps_ = stepper_.counts().steps;
    rejected_ = stepper_.counts().rejected;
  }

  const Stepper& stepper_;
  const double last_;
  const long end_;
  double t_, longest_ = 0.0;
  long steps_ = 0, rejected_ = 0;
};

Ending to_ending(StepResult step) {
  switch (step) {
    case StepResult::underflow: return Ending::underflow;
    case StepResult::no_solution: return Ending::no_solution;
    case StepResult::sliding: return Ending::sliding;
    case StepResult::chattering: return Ending::chattering;
    default: return Ending::not_finite;
  }
}

}  // namespace

DriveResult drive(Stepper& stepper, std::span<const double> times, const Sink& sink, const DriveOptions& options) {
  DriveResult result;
  result.t = stepper.t();
  if (times.empty()) return result;
  const double last = times.back();
  const bool forward = last >= stepper.t();
  if (options.dense) result.dense = DenseOutput(stepper.segment_size(), stepper.evaluate());
  EventSearch search(options.events, stepper.t(), stepper.y());

  std::size_t next = 0;
  while (next < times.size() && times[next] == stepper.t()) {
    sink(next, times.subspan(next, 1), stepper.y());
    ++next;
  }
  Heartbeat heartbeat(options.progress);
  constexpr std::size_t batch_size = 64;
  std::vector<double> rows(batch_size * static_cast<std::size_t>(stepper.dimension()));

  const long first_step = stepper.counts().steps;
  Pace pace(stepper, last, options.max_steps);
  while (stepper.t() != last) {
    if (stepper.counts().steps - first_step >= options.max_steps) {
      result.ending = Ending::max_steps;
      break;
    }
    if (pace.stalled()) {
      result.ending = Ending::stalled;
      break;
    }
    const StepResult step = stepper.advance(last);
    if (step != StepResult::accepted) {
      result.ending = to_ending(step);
      break;
    }
    double reached = stepper.t();

    EventSearch::Found found = search.step(stepper);
    std::move(found.hits.begin(), found.hits.end(), std::back_inserter(result.hits));
    if (found.ended) reached = found.t, result.ending = Ending::event;

    if (options.dense) result.dense.append(stepper.t_old(), stepper.t(), stepper.segment());
    std::size_t end = next;
    while (end < times.size() && (forward ? times[end] <= reached : times[end] >= reached)) ++end;
    while (next < end) {
      const std::size_t count = std::min(end - next, batch_size);
      stepper.interpolate_many(times.data() + next, count, rows.data());
      sink(next, times.subspan(next, count), rows.data());
      next += count;
    }
    result.t = reached;
    if (result.ending == Ending::event) break;
    if (heartbeat.stop_requested(reached, last)) {
      result.ending = Ending::stopped;
      break;
    }
  }
  result.samples = next;
  return result;
}

}  // namespace polhode::ode
