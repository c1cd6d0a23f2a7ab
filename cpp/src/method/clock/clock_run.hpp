#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <vector>

#include "method/clock/clock.hpp"
#include "method/integrate.hpp"
#include "method/samples.hpp"
#include "polhode/ode/event_search.hpp"
#include "polhode/ode/tracked_taylor.hpp"

namespace polhode {

/// A run of a scene with controllers, forward from the start. One stepper goes from instant to instant, at which a tick
/// measures, or a command begins or ends. What is held is constant between them: states of the equations that do not
/// change by themselves.
template <class Series>
class ClockRun {
 public:
  ClockRun(const Scene& scene, const RunOptions& options, const Series& series, const ExtraStates& extra)
      : scene_(scene),
        options_(options),
        series_(series),
        order_(scene.times(), scene.t0()),
        carrying_(options.trace != nullptr ? Carrying{Carry::errors, 3} : Carrying{}),
        clock_(scene, options.body, std::vector<Carrying>(scene.controllers().size(), carrying_),
               options.keep_ticks),
        state_(body_numbers + static_cast<std::size_t>(extra.count), carrying_.count),
        start_(state_) {
    trajectory_.extra = extra;
  }

  Trajectory run(const Unpack& unpack, const MakeStepper& make_stepper) {
    const std::vector<double>& times = scene_.times();
    trajectory_.states.resize(static_cast<std::size_t>(trajectory_.extra.count) * times.size());
    if (scene_.want().omega) trajectory_.omega.resize(3 * times.size());
    if (scene_.want().attitude) trajectory_.attitude.resize(4 * times.size());
    trajectory_.start = scene_.start();
    trajectory_.unpack = unpack;
    trajectory_.has_dense = options_.dense;
    reached_.assign(times.size(), 0);
    if (order_.forward.empty()) return std::move(trajectory_);
    last_ = times[order_.forward.back()];
    stepper_ = make_stepper(series_.start(), last_);
    if (options_.dense) trajectory_.dense_forward = ode::DenseOutput(stepper_->segment_size(), stepper_->evaluate());
    go();
    trajectory_.t_reached = ended_ ? reached_time_ : stepper_->t();
    trajectory_.stats += stepper_->counts();
    drop_unreached(times, reached_, trajectory_);
    trajectory_.ticks = clock_.ticks();
    return std::move(trajectory_);
  }

 private:
  static constexpr std::size_t body_numbers = 7, first_extra = ode::series_width;
  using Plain = ode::Taylor::Stepper<Series>;
  using Tracked = ode::TrackedTaylor<Series>;

  void go() {
    clock_.stop_at(last_);
    act(stepper_->t());
    take_samples_here();
    const auto see = [this](double t, const double* y) { return to_state(t, y); };
    const std::vector<ode::Event> events = make_events(options_.events, see);
    ode::EventSearch search(events, stepper_->t(), plain().state());
    search_ = events.empty() ? nullptr : &search;
    while (next_ < order_.forward.size()) {
      double stop = std::min(last_, clock_.next());
      if (is_same_instant(stop, last_)) stop = last_;
      if (!step_to(stop)) return;
      act(stop);
      if (search_ != nullptr && found_event(search.look(*stepper_, stepper_->t(), plain().state()))) {
        take_samples_here();
        return;
      }
      take_samples_here();
    }
  }

  /// Steps to a time; false if the run ended before it.
  bool step_to(double stop) {
    if (same_ && !options_.dense && search_ == nullptr && stepper_->t() != stop && extend(stop)) {
      take_samples_within(stop);
      return stop_requested() ? end(ode::Ending::stopped) : true;
    }
    while (stepper_->t() != stop) {
      if (stepper_->counts().steps >= options_.max_steps) return end(ode::Ending::max_steps);
      const ode::StepResult step = stepper_->advance(stop);
      if (step != ode::StepResult::accepted) return end(find_ending(step));
      if (options_.dense) trajectory_.dense_forward.append(stepper_->t_old(), stepper_->t(), stepper_->segment());
      if (search_ != nullptr && found_event(search_->step(*stepper_))) {
        take_samples_within(reached_time_, true);
        return false;
      }
      take_samples_within(stop);
      if (stop_requested()) return end(ode::Ending::stopped);
    }
    return true;
  }

  static ode::Ending find_ending(ode::StepResult step) {
    switch (step) {
      case ode::StepResult::underflow: return ode::Ending::underflow;
      case ode::StepResult::no_solution: return ode::Ending::no_solution;
      case ode::StepResult::sliding: return ode::Ending::sliding;
      case ode::StepResult::chattering: return ode::Ending::chattering;
      default: return ode::Ending::not_finite;
    }
  }

  bool end(ode::Ending ending) {
    EndingText text = describe_ending(ending, stepper_->t(), options_.max_steps);
    trajectory_.status = text.status, trajectory_.message = std::move(text.message);
    return false;
  }

  bool stop_requested() {
    if (!options_.progress || (++calls_ & 63) != 0) return false;
    const auto now = std::chrono::steady_clock::now();
    if (now - asked_ < std::chrono::milliseconds(50)) return false;
    asked_ = now;
    return !options_.progress(stepper_->t(), last_);
  }

  /// Keeps zeros of events; true if the run ends at one.
  bool found_event(const ode::EventSearch::Found& found) {
    for (const ode::EventHit& hit : found.hits)
      trajectory_.events.push_back({hit.event, to_state(hit.t, hit.y.data())});
    if (!found.ended) return false;
    ended_ = true, reached_time_ = found.t;
    EndingText text = describe_ending(ode::Ending::event, found.t, options_.max_steps);
    trajectory_.status = text.status, trajectory_.message = std::move(text.message);
    return true;
  }

  State to_state(double t, const double* y) const {
    State state;
    double attitude[4];
    state.t = t;
    series_.unpack(y, 1, state.omega.data(), attitude);
    state.attitude = {attitude[0], attitude[1], attitude[2], attitude[3]};
    state.states = trajectory_.extra.of(y);
    return state;
  }

  /// All that happens at one instant.
  void act(double t) {
    if (!clock_.is_due(t)) return;
    read();
    clock_.act(t, state_);
    write();
  }

  /// Where nothing has changed, the last step's series holds on.
  bool extend(double stop) { return tracked() != nullptr ? tracked()->extend(stop) : plain().extend(stop); }

  Plain& plain() { return static_cast<Plain&>(*stepper_); }
  Tracked* tracked() { return options_.trace != nullptr ? static_cast<Tracked*>(stepper_.get()) : nullptr; }

  /// The state and its errors in body axes.
  void read() {
    const double* y = plain().state();
    series_.unpack(y, 1, state_.values.data(), state_.values.data() + 3);
    std::copy_n(y + first_extra, state_.values.size() - body_numbers, state_.values.begin() + body_numbers);
    if (tracked() == nullptr) {
      start_ = state_;
      return;
    }
    const double scale = 1.0 / options_.trace->scale;
    const auto errors = tracked()->errors();
    for (std::size_t e = 0; e < 3; ++e) {
      double body[first_extra];
      std::copy_n(errors[e], first_extra, body);
      series_.unpack_error(body);
      std::vector<double>& out = state_.changes[e];
      for (std::size_t i = 0; i < 3; ++i) out[i] = scale * body[i];
      for (std::size_t i = 0; i < 4; ++i) out[3 + i] = scale * body[4 + i];
      for (std::size_t i = body_numbers; i < out.size(); ++i) out[i] = scale * errors[e][first_extra + i - body_numbers];
    }
    start_ = state_;
  }

  /// What commands have changed: held numbers, and rates that a wheel's momentum kicks.
  void write() {
    bool changed = false;
    double *y = plain().state(), *carry = plain().carry();
    for (std::size_t i = body_numbers; i < state_.values.size(); ++i) {
      const std::size_t at = first_extra + i - body_numbers;
      if (y[at] == state_.values[i]) continue;
      y[at] = state_.values[i], carry[at] = 0.0, changed = true;
    }
    double kick[first_extra] = {};
    add_kick(state_.values, start_.values, 1.0, kick);
    for (int i = 0; i < 4; ++i) y[i] += kick[i], changed = changed || kick[i] != 0.0;
    Tracked* const tracked_run = tracked();
    same_ = !changed && (tracked_run == nullptr || state_.changes == start_.changes);
    if (same_ || tracked_run == nullptr) return;
    const double scale = options_.trace->scale;
    const auto errors = tracked_run->errors();
    for (std::size_t e = 0; e < 3; ++e) {
      // Without a vector of its own, the second sample is a part of the loss.
      double* const error = errors[e == 2 && !options_.trace->separates_rounding() ? 0 : e];
      const bool adds = error != errors[e];
      for (std::size_t i = body_numbers; i < state_.values.size(); ++i) {
        double& one = error[first_extra + i - body_numbers];
        one = scale * state_.changes[e][i] + (adds ? one : 0.0);
      }
      double moved[first_extra] = {};
      add_kick(state_.changes[e], start_.changes[e], scale, moved);
      for (int i = 0; i < 4; ++i) error[i] += moved[i];
    }
    tracked_run->restart();
  }

  /// A change of the rates in the variables of the run.
  void add_kick(const std::vector<double>& now, const std::vector<double>& old, double scale, double* kick) const {
    bool any = false;
    for (std::size_t i = 0; i < 3; ++i) kick[i] = scale * (now[i] - old[i]), any = any || kick[i] != 0.0;
    if (any) series_.pack_error(kick);
  }

  /// @param event  the run ends at this time, which lies within the last step
  void take_samples_within(double stop, bool event = false) {
    const std::vector<double>& times = scene_.times();
    std::size_t end = next_;
    const auto time = [&](std::size_t i) { return times[order_.forward[i]]; };
    const double last = std::min(stepper_->t(), stop);
    while (end < order_.forward.size() && time(end) <= last && (event || !is_same_instant(time(end), stop))) ++end;
    std::vector<double> at;
    for (; next_ < end; next_ += at.size()) {
      at.clear();
      while (at.size() < 64 && next_ + at.size() < end) at.push_back(time(next_ + at.size()));
      rows_.resize(at.size() * static_cast<std::size_t>(stepper_->dimension()));
      stepper_->interpolate_many(at.data(), at.size(), rows_.data());
      for (std::size_t i = 0; i < at.size(); ++i)
        put(order_.forward[next_ + i], rows_.data() + i * static_cast<std::size_t>(stepper_->dimension()));
    }
  }

  /// A sample on an instant has the state after it.
  void take_samples_here() {
    const std::vector<double>& times = scene_.times();
    const double t = stepper_->t();
    bool any = false;
    for (; next_ < order_.forward.size(); ++next_, any = true) {
      const std::size_t row = order_.forward[next_];
      if (times[row] > t && !is_same_instant(times[row], t)) break;
      put(row, plain().state());
    }
    if (any && tracked() != nullptr) tracked()->add_sample();
  }

  void put(std::size_t row, const double* y) {
    double w[3], q[4];
    series_.unpack(y, 1, w, q);
    if (stepper_->t() == scene_.t0() && stepper_->counts().steps == 0) {   // the start as given, but for a kick
      const Quat& start = scene_.attitude();
      q[0] = start.x, q[1] = start.y, q[2] = start.z, q[3] = start.w;
      if (std::equal(state_.values.begin(), state_.values.begin() + 3, start_.values.begin()))
        std::copy_n(scene_.omega().data(), 3, w);
    }
    if (scene_.want().omega) std::copy_n(w, 3, trajectory_.omega.data() + 3 * row);
    if (scene_.want().attitude) std::copy_n(q, 4, trajectory_.attitude.data() + 4 * row);
    const auto count = static_cast<std::size_t>(trajectory_.extra.count);
    std::copy_n(y + first_extra, count, trajectory_.states.data() + count * row);
    reached_[row] = 1;
  }

  const Scene& scene_;
  const RunOptions& options_;
  const Series& series_;
  SampleOrder order_;
  Carrying carrying_;
  Clock clock_;
  std::unique_ptr<ode::Stepper> stepper_;
  Carried state_, start_;   ///< at an instant: with its commands, and as it was read
  Trajectory trajectory_;
  std::vector<unsigned char> reached_;
  std::vector<double> rows_;
  double last_ = 0.0;
  ode::EventSearch* search_ = nullptr;   ///< where there are events
  bool ended_ = false;                   ///< at an event
  double reached_time_ = 0.0;
  bool same_ = false;   ///< the last instant has changed nothing
  std::size_t next_ = 0;
  unsigned calls_ = 0;
  std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
};

}  // namespace polhode
