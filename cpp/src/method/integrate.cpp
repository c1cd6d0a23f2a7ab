#include "method/integrate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "method/samples.hpp"
#include "polhode/core/error.hpp"

namespace polhode {
namespace {

State to_state(const Unpack& unpack, const ExtraStates& extra, double t, const double* y) {
  State state;
  double attitude[4] = {NAN, NAN, NAN, NAN};
  state.t = t;
  unpack(y, 1, state.omega.data(), attitude);
  state.attitude = {attitude[0], attitude[1], attitude[2], attitude[3]};
  if (extra.count > 0) state.states = extra.of(y);
  return state;
}

/// Copies the rows of one direction of time into the trajectory.
class SampleRows {
 public:
  SampleRows(const Scene& scene, const Unpack& unpack, const std::vector<std::size_t>& order,
             std::vector<unsigned char>& reached, Trajectory& trajectory)
      : scene_(scene), unpack_(unpack), order_(order), reached_(reached), trajectory_(trajectory) {
    for (std::size_t i = 0; i < order.size(); ++i) consecutive_ = consecutive_ && order[i] == order[0] + i;
  }

  void operator()(std::size_t first, std::span<const double> times, const double* rows) {
    const Wanted want = scene_.want();
    const std::size_t count = times.size();
    const bool omega_in_place = consecutive_ && want.omega, attitude_in_place = consecutive_ && want.attitude;
    if (!omega_in_place) omega_.resize(3 * count);
    if (!attitude_in_place) attitude_.resize(4 * count);
    double* w = omega_in_place ? trajectory_.omega.data() + 3 * order_[first] : omega_.data();
    double* q = attitude_in_place ? trajectory_.attitude.data() + 4 * order_[first] : attitude_.data();
    unpack_(rows, count, w, q);
    const ExtraStates& extra = trajectory_.extra;
    for (std::size_t i = 0; extra.count > 0 && i < count; ++i)
      std::copy_n(rows + static_cast<std::size_t>(extra.row) * i + extra.first, extra.count,
                  trajectory_.states.data() + static_cast<std::size_t>(extra.count) * order_[first + i]);
    for (std::size_t i = 0; i < count && times[i] == scene_.t0(); ++i) {
      // The start is returned as given, for any variables of the method.
      const Quat& start = scene_.attitude();
      std::copy_n(scene_.omega().data(), 3, w + 3 * i);
      q[4 * i] = start.x, q[4 * i + 1] = start.y, q[4 * i + 2] = start.z, q[4 * i + 3] = start.w;
    }
    if (consecutive_) {
      std::fill_n(reached_.begin() + static_cast<std::ptrdiff_t>(order_[first]), count, 1);
      return;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t row = order_[first + i];
      if (want.omega) std::copy_n(w + 3 * i, 3, trajectory_.omega.data() + 3 * row);
      if (want.attitude) std::copy_n(q + 4 * i, 4, trajectory_.attitude.data() + 4 * row);
      reached_[row] = 1;
    }
  }

 private:
  const Scene& scene_;
  const Unpack& unpack_;
  const std::vector<std::size_t>& order_;
  std::vector<unsigned char>& reached_;
  Trajectory& trajectory_;
  bool consecutive_ = true;
  std::vector<double> omega_, attitude_;
};

/// The torques at a time, with the state held, as the largest difference of two times relative to their size.
bool jumps_with_time(const Scene& scene, const State& state) {
  const double q[4] = {state.attitude.x, state.attitude.y, state.attitude.z, state.attitude.w};
  const bool known = std::isfinite(q[0] + q[1] + q[2] + q[3]);
  const Quat& start = scene.attitude();
  const double at_start[4] = {start.x, start.y, start.z, start.w};
  Vector3d before = Vector3d::Zero(), after = Vector3d::Zero();
  const double around = 64 * std::numeric_limits<double>::epsilon() * std::abs(state.t);
  for (const AnyTorque& torque : scene.torques()) {
    if (!std::holds_alternative<torques::Custom>(torque)) continue;
    for (const auto& [t, sum] : {std::pair{state.t - around, &before}, std::pair{state.t + around, &after}})
      std::get<torques::Custom>(torque).add(
          TorqueInput{t, state.omega.data(), known ? q : at_start, scene.inertia_B().matrix()}, sum->data());
  }
  return (after - before).norm() > 1e-6 * std::max(after.norm(), before.norm());
}

/// The operation of a formula that has no derivatives near a state.
std::string explain_singular(const Scene& scene, const State& state) {
  constexpr double near = 1e-6;
  if (!std::isfinite(norm(state.attitude))) return "";
  const std::string found = find_singular(scene.torques(), scene.inertia_B().matrix(), state, near);
  if (found.empty()) return "";
  return "; the formula has no derivatives there, by " + found + ", which goes to 0; for a norm write norm(v, smooth=1e-6)";
}

/// Why steps became too short, where a torque of the user's own acts.
std::string explain_underflow(const Scene& scene, const State& state) {
  const auto is_custom = [](const AnyTorque& torque) { return std::holds_alternative<torques::Custom>(torque); };
  if (std::none_of(scene.torques().begin(), scene.torques().end(), is_custom)) return "";
  const std::string at = polhode::to_text(state.t);
  if (jumps_with_time(scene, state)) {
    return "; your torque jumps near t = " + at + " s: use np.where in a Formula, During, or give Custom this time in "
           "breaks=";
  }
  return "; near t = " + at + " s your torque jumps with the state or grows without limit: use np.where in a Formula, "
         "smooth it, or end the span there by an event and go on from its state";
}

}  // namespace

std::vector<ode::Event> make_events(std::span<const SceneEvent> events, const ToState& to_state) {
  std::vector<ode::Event> converted;
  for (const SceneEvent& event : events) {
    converted.push_back({[&event, to_state](double t, const double* y) {
                      const double value = event.function(to_state(t, y));
                      if (std::isnan(value)) {
                        throw InvalidInput("the event's function", "a number",
                                           "nan at t = " + polhode::to_text(t) + " s");
                      }
                      return value;
                    },
                    event.direction, event.terminal});
  }
  return converted;
}

EndingText describe_ending(ode::Ending ending, double t, long max_steps) {
  const std::string at = polhode::to_text(t) + " s", when = " at t = " + at;
  using ode::Ending;
  switch (ending) {
    case Ending::finished: break;
    case Ending::event: return {Status::event, "ended by a terminal event" + when};
    case Ending::max_steps:
      return {Status::max_steps, "gave up after max_steps = " + std::to_string(max_steps) + " steps" + when};
    case Ending::stalled:
      return {Status::max_steps, "gave up" + when + ": the steps there are a thousand times shorter than before, or too "
              "short for max_steps = " + std::to_string(max_steps) + ", and many are rejected"};
    case Ending::stopped: return {Status::stopped, "stopped by the progress callback" + when};
    case Ending::underflow:
      return {Status::failed, "the step became smaller than the spacing of the times" + when};
    case Ending::not_finite: return {Status::failed, "the derivative is not finite just beyond t = " + at};
    case Ending::sliding:
      return {Status::sliding,
              "the motion slides on the surface of a switch from t = " + at + " on: both of its branches push back to it, "
              "so the formula has no torque there; use friction(load, rate) for dry friction, or a smooth branch"};
    case Ending::chattering:
      return {Status::failed, "the formula switches again and again near t = " + at + ", more than 100 times in the "
              "time of ten steps; give the switch a width"};
    case Ending::no_solution:
      return {Status::failed,
              "the implicit equations of a step have no solution near t = " + at + "; take shorter steps"};
  }
  return {Status::finished, ""};
}

Trajectory integrate(const Scene& scene, const RunOptions& options, const double* y0, const Unpack& unpack,
                     const MakeStepper& make_stepper, const ExtraStates& extra) {
  Trajectory trajectory;
  trajectory.extra = extra;
  trajectory.states.resize(static_cast<std::size_t>(extra.count) * scene.times().size());
  const std::vector<double>& times = scene.times();
  if (scene.want().omega) trajectory.omega.resize(3 * times.size());
  if (scene.want().attitude) trajectory.attitude.resize(4 * times.size());
  trajectory.start = scene.start();
  trajectory.t_reached = scene.t0();
  trajectory.unpack = unpack;
  trajectory.has_dense = options.dense;

  const std::vector<ode::Event> events = make_events(
      options.events, [&](double t, const double* y) { return to_state(unpack, extra, t, y); });
  std::vector<unsigned char> reached(times.size(), 0);
  // Returns false if the run must not continue in the other direction.
  const auto integrate_direction = [&](const std::vector<std::size_t>& order, ode::DenseOutput& dense) {
    if (order.empty()) return true;
    std::vector<double> sorted(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = times[order[i]];
    const std::unique_ptr<ode::Stepper> stepper = make_stepper(y0, sorted.back());
    SampleRows rows(scene, unpack, order, reached, trajectory);
    ode::DriveResult result =
        ode::drive(*stepper, std::span<const double>(sorted), std::ref(rows),
                   ode::DriveOptions{options.max_steps, options.dense, std::span<const ode::Event>(events),
                                     options.progress});
    for (const ode::EventHit& hit : result.hits)
      trajectory.events.push_back({hit.event, to_state(unpack, extra, hit.t, hit.y.data())});
    dense = std::move(result.dense);
    trajectory.stats += stepper->counts();
    trajectory.t_reached = result.t;
    if (result.ending == ode::Ending::finished) return true;
    EndingText text = describe_ending(result.ending, result.t, options.max_steps);
    trajectory.status = text.status, trajectory.message = std::move(text.message);
    if (result.ending == ode::Ending::underflow || result.ending == ode::Ending::not_finite)
      trajectory.message += explain_singular(scene, to_state(unpack, extra, result.t, stepper->y()));
    if (result.ending == ode::Ending::underflow || result.ending == ode::Ending::stalled)
      trajectory.message += explain_underflow(scene, to_state(unpack, extra, result.t, stepper->y()));
    return trajectory.status == Status::event || trajectory.status == Status::sliding;
  };
  const SampleOrder order(times, scene.t0());
  if (integrate_direction(order.backward, trajectory.dense_backward))
    integrate_direction(order.forward, trajectory.dense_forward);

  drop_unreached(times, reached, trajectory);
  return trajectory;
}

}  // namespace polhode
