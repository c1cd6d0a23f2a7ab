#include "run.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "polhode/core/error.hpp"
#include "polhode/ode/drive.hpp"
#include "solve/answered.hpp"
#include "solve/itinerary.hpp"

namespace polhode {

Motion run(const Scene& scene, const SolveOptions& options, const double* y0, const Unpack& unpack,
           const MakeStepper& make_stepper) {
  Motion motion;
  const std::vector<double>& times = scene.times();
  const std::size_t n = times.size();
  const Wanted want = scene.want();
  if (want.omega) motion.omega.resize(3 * n);
  if (want.attitude) motion.attitude.resize(4 * n);
  motion.start = scene.start();
  motion.t_reached = scene.t0();
  motion.unpack = unpack;
  motion.has_dense = options.dense;

  const auto to_state = [&unpack](double t, const double* y) {
    State state;
    double attitude[4] = {NAN, NAN, NAN, NAN};
    state.t = t;
    unpack(y, 1, state.omega.data(), attitude);
    state.attitude = {attitude[0], attitude[1], attitude[2], attitude[3]};
    return state;
  };
  std::vector<ode::Event> events;
  for (const SceneEvent& event : options.events) {
    events.push_back({[&](double t, const double* y) {
                        const double value = event.function(to_state(t, y));
                        if (std::isnan(value)) {
                          throw InvalidInput("the event's function", "a number",
                                             "nan at t = " + polhode::to_text(t) + " s");
                        }
                        return value;
                      },
                      event.direction, event.terminal});
  }

  std::vector<unsigned char> answered(n, 0);
  const auto one_way = [&](const std::vector<std::size_t>& order, ode::DenseOutput& dense) {
    if (order.empty()) return true;
    std::vector<double> sorted(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = times[order[i]];
    const std::unique_ptr<ode::Stepper> stepper = make_stepper(y0, sorted.back());
    bool straight = true;   // the answers stand where they are wanted
    for (std::size_t i = 0; i < order.size(); ++i) straight = straight && order[i] == order[0] + i;
    std::vector<double> omega, attitude;
    const auto sink = [&](std::size_t first, std::span<const double> at, const double* rows) {
      const std::size_t count = at.size();
      const bool omega_here = straight && want.omega, attitude_here = straight && want.attitude;
      if (!omega_here) omega.resize(3 * count);
      if (!attitude_here) attitude.resize(4 * count);
      double* w = omega_here ? motion.omega.data() + 3 * order[first] : omega.data();
      double* q = attitude_here ? motion.attitude.data() + 4 * order[first] : attitude.data();
      unpack(rows, count, w, q);
      for (std::size_t i = 0; i < count && at[i] == scene.t0(); ++i) {
        // Whatever variables the method carries: the start is as it was given.
        const Quat& start = scene.attitude();
        std::copy_n(scene.omega().data(), 3, w + 3 * i);
        q[4 * i] = start.x, q[4 * i + 1] = start.y, q[4 * i + 2] = start.z, q[4 * i + 3] = start.w;
      }
      if (straight) {
        std::fill_n(answered.begin() + static_cast<std::ptrdiff_t>(order[first]), count, 1);
        return;
      }
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t row = order[first + i];
        if (want.omega) std::copy_n(w + 3 * i, 3, motion.omega.data() + 3 * row);
        if (want.attitude) std::copy_n(q + 4 * i, 4, motion.attitude.data() + 4 * row);
        answered[row] = 1;
      }
    };
    ode::DriveResult result = ode::drive(
        *stepper, std::span<const double>(sorted), sink,
        ode::DriveOptions{options.max_steps, options.dense, std::span<const ode::Event>(events),
                          options.progress});
    for (const ode::EventHit& hit : result.hits) motion.events.push_back({hit.event, to_state(hit.t, hit.y.data())});
    dense = std::move(result.dense);
    motion.stats += stepper->counts();
    motion.t_reached = result.t;
    using ode::Ending;
    const std::string when = " at t = " + polhode::to_text(result.t) + " s";
    switch (result.ending) {
      case Ending::finished: return true;
      case Ending::event:
        motion.status = Status::event;
        motion.message = "ended by a terminal event" + when;
        return true;
      case Ending::max_steps:
        motion.status = Status::max_steps;
        motion.message = "gave up after max_steps = " + std::to_string(options.max_steps) + " steps" + when;
        return false;
      case Ending::stopped:
        motion.status = Status::stopped;
        motion.message = "stopped by the progress callback" + when;
        return false;
      case Ending::underflow:
        motion.status = Status::failed;
        motion.message = "the step became smaller than the spacing of the times" + when;
        return false;
      case Ending::not_finite:
        motion.status = Status::failed;
        motion.message = "the derivative is not finite just beyond t = " + polhode::to_text(result.t) + " s";
        return false;
      case Ending::no_solution:
        motion.status = Status::failed;
        motion.message = "the implicit equations of a step have no solution near" + when + ": take shorter steps";
        return false;
    }
    return false;
  };
  const Itinerary itinerary(times, scene.t0());
  if (one_way(itinerary.backward, motion.dense_backward)) one_way(itinerary.forward, motion.dense_forward);

  keep_answered(times, answered, motion);
  return motion;
}

}  // namespace polhode
