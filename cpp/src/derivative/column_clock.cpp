#include <algorithm>
#include <cmath>
#include <memory>

#include "derivative/column_run.hpp"
#include "method/clock/clock.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/interrupt.hpp"

// The columns of a loop: between ticks those of the body with held commands, which are states. At a tick the columns of
// what is measured go through the derivative of the law, into the command and the states of the controller.
namespace polhode {

using Of = SceneParameter::Of;

namespace {

constexpr std::size_t body_numbers = 7;
constexpr double largest_column = 0x1p200, least_column = 0x1p-200;   ///< that are not scaled

[[noreturn]] void refuse_column(const std::string& column, const std::string& cause) {
  throw InvalidInput("sensitivity", "without '" + column + "' beside these controllers", "it", cause);
}

/// Refuses what a tick depends on beside the state, its own numbers and the controller's.
void require_carried(const Scene& scene, const std::vector<SceneParameter>& parameters) {
  const auto& controllers = scene.controllers();
  const auto& rotors = scene.rotors();
  const bool measured = std::ranges::any_of(controllers, [](const Controller& one) { return one.parts().rotors > 0; });
  const bool kicks = std::ranges::any_of(
      controllers, [](const Controller& one) { return one.parts().output == Output::rotor_momentum; });
  const bool kept = std::ranges::any_of(rotors, [](const Rotor& one) { return one.free() && !one.is_driven(); });
  for (const SceneParameter& parameter : parameters) {
    const bool of_body = parameter.of == Of::inertia || parameter.of == Of::axes;
    if (of_body && kicks)
      refuse_column(parameter.column, "a command of rotor_momentum changes omega by the inverse of the inertia");
    if (of_body && !scene.held_windows().empty())
      refuse_column(parameter.column, "a torque in windows has its inertia as a number");
    if (parameter.of == Of::rotor && measured)
      refuse_column(parameter.column, "a controller measures the speeds of rotors, of which it is a part");
    if (parameter.of == Of::omega && measured && kept)
      refuse_column(parameter.column, "a controller measures the speed of a free rotor that nothing drives");
  }
}

std::vector<Carrying> list_carrying(const Scene& scene, const std::vector<SceneParameter>& parameters,
                                    double accuracy) {
  std::vector<Carrying> all(scene.controllers().size(), Carrying{Carry::columns, parameters.size(), {}, {}, accuracy});
  for (std::size_t c = 0; c < parameters.size(); ++c) {
    const SceneParameter& parameter = parameters[c];
    if (parameter.of == Of::controller) all[parameter.index].by.push_back({c, parameter.component});
    if (parameter.of == Of::controller_state) all[parameter.index].by_start.push_back({c, parameter.component});
  }
  return all;
}

/// A state with its columns, as ticks see it: the attitude's change is that of a quaternion.
class Instant {
 public:
  Instant(std::size_t states, std::size_t count) : at_(body_numbers + states, count), states_(states), count_(count) {}

  Carried& at() { return at_; }

  void read(const State& state, const std::vector<double>& columns) {
    const Quat& q = state.attitude;
    const double body[body_numbers] = {state.omega[0], state.omega[1], state.omega[2], q.x, q.y, q.z, q.w};
    std::copy_n(body, body_numbers, at_.values.begin());
    std::copy(state.states.begin(), state.states.end(), at_.values.begin() + body_numbers);
    for (std::size_t c = 0; c < count_; ++c) {
      std::vector<double>& change = at_.changes[c];
      const auto row = [&](std::size_t i) { return columns[i * count_ + c]; };
      for (std::size_t i = 0; i < 3; ++i) change[i] = row(i);
      const Quat change_q = q * Quat{0.5 * row(3), 0.5 * row(4), 0.5 * row(5), 0.0};
      change[3] = change_q.x, change[4] = change_q.y, change[5] = change_q.z, change[6] = change_q.w;
      for (std::size_t i = 0; i < states_; ++i) change[body_numbers + i] = row(6 + i);
    }
    omega_ = state.omega;
  }

  void write(ColumnMotion& motion, std::vector<double>& columns) {
    Vector3d jump;
    for (int i = 0; i < 3; ++i) jump[i] = at_.values[static_cast<std::size_t>(i)] - omega_[i];
    for (std::size_t c = 0; c < count_; ++c) {
      for (std::size_t i = 0; i < 3; ++i) columns[i * count_ + c] = at_.changes[c][i];
      for (std::size_t i = 0; i < states_; ++i) columns[(6 + i) * count_ + c] = at_.changes[c][body_numbers + i];
    }
    motion.change(jump, {at_.values.begin() + body_numbers, at_.values.end()}, columns);
  }

 private:
  Carried at_;
  Vector3d omega_;
  std::size_t states_, count_;
};

/// The power of two that brings the largest column near 1; 0 within the range.
int find_scale(const std::vector<double>& columns) {
  double size = 0.0;
  for (const double number : columns) size = std::max(size, std::abs(number));
  if (!(size > 0.0) || (size < largest_column && size > least_column) || !std::isfinite(size)) return 0;
  return std::ilogb(size);
}

std::string describe_uncertain(const Clock& clock) {
  for (std::size_t i = 0; i < clock.channels().size(); ++i)
    if (const auto& tick = clock.channels()[i]->uncertain())
      return "a branch of controller " + std::to_string(i) + " is not certain at tick " + std::to_string(*tick) +
             ": from there on the derivatives may be those of another branch";
  return "";
}

}  // namespace

void ColumnRun::follow_clock(const Piece& piece, const std::vector<std::size_t>& order, double rtol, long max_steps,
                             ColumnSamples& out) const {
  require_carried(scene_, parameters_);
  const std::size_t count = parameters_.size();
  const double last = scene_.times()[order.back()];
  SampleTarget target(out, states_, count);
  out.scale.assign(scene_.times().size(), 0);
  Clock clock(scene_, loop_.body, list_carrying(scene_, parameters_, loop_.accuracy), false);
  clock.stop_at(last);
  State state = scene_.start();
  std::vector<double> columns = start_columns();
  const auto motion = make_column_motion(scene_, find_causes(piece, find_rotating(piece)), columns, last,
                                         {.rtol = rtol}, equations_[&piece]);
  Instant instant(states_, count);
  std::size_t next = 0;
  int scale = 0;
  const auto act = [&](double t) {
    motion->end(state, columns);
    if (clock.is_due(t)) {
      instant.read(state, columns);
      clock.act(t, instant.at());
      instant.write(*motion, columns);
      motion->end(state, columns);
    }
    const Quat& q = state.attitude;
    const double attitude[4] = {q.x, q.y, q.z, q.w};
    for (; next < order.size(); ++next) {
      const double time = scene_.times()[order[next]];
      if (time > t && !is_same_instant(time, t)) break;
      target.put(order[next], state.omega.data(), attitude, columns.data());
      out.scale[order[next]] = scale;
    }
    const int by = loop_.rescale ? find_scale(columns) : 0;
    if (by == 0) return;
    const double factor = std::ldexp(1.0, -by);
    for (double& number : columns) number *= factor;
    clock.scale_changes(factor);
    motion->change(Vector3d::Zero(), state.states, columns);
    scale += by;
  };
  act(scene_.t0());
  while (next < order.size()) {
    double stop = std::min(last, clock.next());
    if (is_same_instant(stop, last)) stop = last;
    while (motion->t() != stop) {
      check_interrupt();
      if (out.steps++ >= max_steps)
        throw IntegrationFailure(motion->t(), "sensitivity: more than " + std::to_string(max_steps) + " steps");
      const ode::StepResult result = motion->advance(stop);
      if (result == ode::StepResult::sliding || result == ode::StepResult::chattering)
        throw IntegrationFailure(motion->t(), "sensitivity: the motion stays on the surface of a switch");
      if (result != ode::StepResult::accepted)
        throw IntegrationFailure(motion->t(), "sensitivity: the motion or its derivatives leave the range of float64");
      std::size_t within = 0;   // samples at the instant come after what happens there
      for (; next + within < order.size(); ++within) {
        const double time = scene_.times()[order[next + within]];
        if (time > motion->t() || is_same_instant(time, stop)) break;
        out.scale[order[next + within]] = scale;
      }
      if (within > 0) target.put(*motion, scene_.times(), order.data() + next, within);
      next += within;
    }
    act(stop);
  }
  out.uncertain = describe_uncertain(clock);
}

}  // namespace polhode
