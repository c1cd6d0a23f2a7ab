#include "method/clock/channel.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "polhode/core/error.hpp"

namespace polhode {
namespace {

using formula::Vec;

constexpr std::size_t omega_at = 0, attitude_at = 3, body_numbers = 7;

Quat get_attitude(const std::vector<double>& values) { return {values[3], values[4], values[5], values[6]}; }
void set_attitude(const Quat& q, std::vector<double>& values) {
  values[3] = q.x, values[4] = q.y, values[5] = q.z, values[6] = q.w;
}

/// What a small change of the attitude makes of a vector of space axes in body axes; a polynomial of degree 2.
Vec<double, 3> change_seen(const Vec<double, 4>& q, const double* change, const Vec<double, 3>& v) {
  double size = 0.0;
  for (int i = 0; i < 4; ++i) size = std::max(size, std::abs(change[i]));
  if (!(size > 0.0)) return {};
  Vec<double, 4> more, less;
  for (std::size_t i = 0; i < 4; ++i) more[i] = q[i] + change[i] / size, less[i] = q[i] - change[i] / size;
  return (formula::rotate_to_body(more, v) - formula::rotate_to_body(less, v)) * (0.5 * size);
}

}  // namespace

bool is_same_instant(double a, double b) {
  const double apart = std::abs(a - b);   // infinite where one time never comes
  return apart <= 4 * rounding_unit * std::max(std::abs(a), std::abs(b)) && apart < std::numeric_limits<double>::infinity();
}

Channel::Channel(const Scene& scene, std::size_t number, std::uint64_t body, const Carrying& carrying,
                 bool keep_ticks)
    : scene_(scene),
      controller_(scene.controllers()[number]),
      number_(number),
      body_(body),
      carrying_(carrying),
      keep_ticks_(keep_ticks),
      update_(controller_, carrying),
      memory_(formula::list_values(controller_.inputs()), carrying.count),
      states_(formula::list_values(controller_.parts().law.states).size()),
      in_(body_numbers + memory_.values.size(), carrying.count),
      out_(memory_.values.size(), carrying.count),
      zero_(controller_.count_commands(), carrying.count) {
  for (const std::string& name : controller_.held()) {
    const formula::Place found = formula::find_place(scene.states(), name);
    for (int i = 0; i < found.count; ++i) held_.push_back(body_numbers + static_cast<std::size_t>(found.first + i));
  }
  const ControllerParts& parts = controller_.parts();
  if (parts.field) field_ = body_numbers + place("field");
  if (parts.rotors > 0) speed_ = body_numbers + place("speed");
  omega_noise_ = make_noise("omega", Distribution::normal, parts.measure.omega_noise);
  attitude_noise_ = make_noise("attitude", Distribution::rotation, parts.measure.attitude_noise);
  field_noise_ = make_noise("field", Distribution::normal, parts.measure.field_noise);
  for (const ParameterColumn& one : carrying.by_start)
    memory_.changes[one.column][memory_.values.size() - states_ + static_cast<std::size_t>(one.number)] = 1.0;
  const double before = std::ceil((scene.t0() - parts.start) / parts.period) - 1.0;
  tick_ = before > 0.0 ? static_cast<std::uint64_t>(before) : 0;
  while (next_tick() < scene.t0() && !is_same_instant(next_tick(), scene.t0())) ++tick_;
}

double Channel::next() const {
  double t = std::min(off_, pending_.empty() ? std::numeric_limits<double>::infinity() : pending_.front().t);
  if (const double tick = next_tick(); tick < end_ && !is_same_instant(tick, end_)) t = std::min(t, tick);
  return t;
}

void Channel::end_pulse(double t, Carried& state) {
  if (!(off_ < t) && !is_same_instant(off_, t)) return;
  off_ = std::numeric_limits<double>::infinity();
  hold(zero_, state);
}

void Channel::begin_commands(double t, Carried& state) {
  while (!pending_.empty() && (pending_.front().t <= t || is_same_instant(pending_.front().t, t))) {
    hold(pending_.front().command, state);
    if (const auto& width = controller_.parts().width) off_ = pending_.front().t + *width;
    spare_.push_back(std::move(pending_.front().command));
    pending_.pop_front();
  }
}

void Channel::hold(const Carried& command, Carried& state) {
  Vector3d kick = Vector3d::Zero();
  std::vector<Vector3d> kicks;
  if (controller_.parts().output == Output::rotor_momentum) kicks.assign(carrying_.count, kick);
  for (std::size_t i = 0; i < held_.size(); ++i) {
    const std::size_t at = held_[i];
    if (controller_.parts().output == Output::rotor_momentum) {   // J w + h stays
      const Vector3d& a = scene_.rotors()[i].axis();
      kick -= (command.values[i] - state.values[at]) * a;
      for (std::size_t e = 0; e < carrying_.count; ++e) kicks[e] -= (command.changes[e][i] - state.changes[e][at]) * a;
    }
    state.values[at] = command.values[i];
    for (std::size_t e = 0; e < carrying_.count; ++e) state.changes[e][at] = command.changes[e][i];
  }
  if (controller_.parts().output != Output::rotor_momentum) return;
  const Matrix3d inverse = scene_.inertia_B().matrix().inverse();
  const Vector3d change = inverse * kick;
  for (std::size_t i = 0; i < 3; ++i) {
    state.values[i] += change[static_cast<int>(i)];
    for (std::size_t e = 0; e < carrying_.count; ++e) state.changes[e][i] += (inverse * kicks[e])[static_cast<int>(i)];
    if (carries_errors()) state.widen(i, 8 * rounding_unit * (inverse.cwiseAbs() * kick.cwiseAbs())[static_cast<int>(i)]);
  }
}

std::size_t Channel::place(std::string_view name) const {
  return static_cast<std::size_t>(formula::find_place(controller_.inputs(), name).first);
}

void Channel::fill_inputs(double t, const Carried& state, Carried& in) const {
  const std::size_t numbers = memory_.values.size();
  std::copy_n(state.values.begin(), body_numbers, in.values.begin());
  std::copy_n(memory_.values.begin(), numbers, in.values.begin() + body_numbers);
  for (std::size_t e = 0; e < carrying_.count; ++e) {
    std::copy_n(state.changes[e].begin(), body_numbers, in.changes[e].begin());
    std::copy_n(memory_.changes[e].begin(), numbers, in.changes[e].begin() + body_numbers);
  }
  const ControllerParts& parts = controller_.parts();
  if (parts.field) {
    const std::size_t at = field_;
    const Vec<double, 3> B_W = formula::make_vector<double>(parts.field->at(t));
    const Vec<double, 4> q{{state.values[3], state.values[4], state.values[5], state.values[6]}};
    const Vec<double, 3> B = formula::rotate_to_body(q, B_W);
    for (std::size_t e = 0; e < carrying_.count; ++e) {
      const Vec<double, 3> moved = change_seen(q, state.changes[e].data() + attitude_at, B_W);
      for (std::size_t i = 0; i < 3; ++i) in.changes[e][at + i] = moved[i];
    }
    const double size = norm(B_W);
    for (std::size_t i = 0; i < 3; ++i) {
      in.values[at + i] = B[i];
      if (carries_errors()) in.widen(at + i, 16 * rounding_unit * size);
    }
  }
  if (parts.rotors == 0) return;
  const std::size_t at = speed_;
  const Vector3d w(state.values[0], state.values[1], state.values[2]);
  for (std::size_t i = 0; i < static_cast<std::size_t>(parts.rotors); ++i) {
    const Rotor& rotor = scene_.rotors()[i];
    const double inertia = rotor.inertia().value_or(std::numeric_limits<double>::quiet_NaN());
    double momentum = rotor.compute_start_momentum(scene_.omega());
    std::size_t own = 0;   // of its state
    if (rotor.is_driven()) {
      own = body_numbers + static_cast<std::size_t>(formula::find_place(scene_.states(), rotor.state()).first);
      momentum = state.values[own];
    }
    in.values[at + i] = rotor.compute_speed(momentum, w);
    for (std::size_t e = 0; e < carrying_.count; ++e) {
      const Vector3d moved(state.changes[e][0], state.changes[e][1], state.changes[e][2]);
      in.changes[e][at + i] = (own > 0 ? state.changes[e][own] / inertia : 0.0) -
                             (rotor.free() ? rotor.axis().dot(moved) : 0.0);
    }
    if (carries_errors()) in.widen(at + i, 4 * rounding_unit * (std::abs(momentum / inertia) + w.norm()));
  }
}

std::optional<Channel::Noise> Channel::make_noise(const char* quantity, Distribution distribution, double size) const {
  if (!(size > 0.0)) return std::nullopt;
  const bool one_row = distribution == Distribution::rotation;
  const double rows[] = {0.0, size, 0.0, size, 0.0, size}, row[] = {size, size, size};
  const std::string name = "controllers." + std::to_string(number_) + "." + quantity;
  return Noise{draw_key(name), Draw(distribution, one_row ? row : rows, one_row ? 1 : 3, one_row ? 3 : 2)};
}

void Channel::add_noise(Carried& in) const {
  double drawn[4];
  const auto draw = [&](const std::optional<Noise>& noise) {
    if (noise) noise->draw({controller_.parts().measure.seed, noise->key, tick_}, body_, 1, drawn);
    return noise.has_value();
  };
  if (draw(omega_noise_))
    for (std::size_t i = 0; i < 3; ++i) in.values[omega_at + i] += drawn[i];
  if (draw(attitude_noise_)) {
    const Quat rotated{drawn[0], drawn[1], drawn[2], drawn[3]};
    set_attitude(get_attitude(in.values) * rotated, in.values);
    for (std::vector<double>& error : in.changes) set_attitude(get_attitude(error) * rotated, error);
  }
  if (draw(field_noise_))
    for (std::size_t i = 0; i < 3; ++i) in.values[field_ + i] += drawn[i];
}

void Channel::round(Carried& in) {
  const double quantum = controller_.parts().measure.omega_quantum;
  if (!(quantum > 0.0)) return;
  const double rate = std::max({std::abs(in.values[0]), std::abs(in.values[1]), std::abs(in.values[2])});
  for (std::size_t i = omega_at; i < omega_at + 3; ++i) {
    const double x = in.values[i], error = carries_errors() ? in.find_error(i) : 0.0;
    const double below = std::floor(x / quantum), above = std::fma(-(below + 0.5), quantum, x);   // half a quantum
    const bool even = std::fmod(below, 2.0) == 0.0;
    const double whole = above > 0.0 || (above == 0.0 && !even) ? below + 1.0 : below;
    in.values[i] = whole * quantum;
    for (std::vector<double>& one : in.changes) one[i] = 0.0;
    const double far = std::min(std::abs(above), quantum - std::abs(above));   // the half below, too
    if (carries_columns() && std::min(far, std::abs(above)) <= carrying_.accuracy * rate) doubt();
    if (error > 0.0 && std::min(far, std::abs(above)) <= certain_errors * error) in.widen(i, quantum + error);
  }
}

void Channel::clip(Carried& command) {
  const std::vector<double>& limits = controller_.parts().limit;
  if (limits.empty()) return;
  for (std::size_t i = 0; i < command.values.size(); ++i) {
    const double limit = limits[limits.size() > 1 ? i : 0], size = std::abs(command.values[i]);
    // A command next to its limit keeps its error: clipping makes no difference larger.
    if (carries_columns() && std::abs(size - limit) <= carrying_.accuracy * limit) doubt();
    if (size - limit > (carries_errors() ? certain_errors * command.find_error(i) : 0.0))
      for (std::vector<double>& error : command.changes) error[i] = 0.0;
    command.values[i] = std::clamp(command.values[i], -limit, limit);
  }
}

/// The law at the attitude of w >= 0, and the jump to the other sign where w is next to 0.
void Channel::call(double t, const Carried& in, Carried& out) {
  std::copy(in.values.begin() + body_numbers, in.values.end(), out.values.begin());
  update_(t, tick_, in, carrying_.what, out);
  if (!update_.is_certain()) doubt();
  const double size = std::abs(in.values[attitude_at + 3]);
  const double error = carries_errors() ? in.find_error(attitude_at + 3) : 0.0;
  if (!(carries_columns() ? size <= carrying_.accuracy : error > 0.0 && size <= certain_errors * error)) return;
  Carried other = in, rotated = out;
  for (std::size_t i = attitude_at; i < attitude_at + 4; ++i) other.values[i] = -in.values[i];
  update_(t, tick_, other, Carry::nothing, rotated);
  for (std::size_t i = 0; i < out.values.size(); ++i) {
    const double jump = std::abs(rotated.values[i] - out.values[i]);
    if (jump > 0.0 && carries_columns()) doubt();
    if (jump > 0.0 && carries_errors()) out.widen(i, jump);
  }
}

void Channel::record(double t, const Carried& command) {
  const std::size_t commands = command.values.size(), first = memory_.values.size() - states_;
  ticks_.t.push_back(t);
  ticks_.measurement.insert(ticks_.measurement.end(), in_.values.begin(), in_.values.begin() + body_numbers);
  ticks_.measurement.insert(ticks_.measurement.end(),
                            in_.values.begin() + static_cast<std::ptrdiff_t>(body_numbers + commands),
                            in_.values.begin() + static_cast<std::ptrdiff_t>(body_numbers + first));
  ticks_.command.insert(ticks_.command.end(), command.values.begin(), command.values.end());
  ticks_.states.insert(ticks_.states.end(), memory_.values.begin() + static_cast<std::ptrdiff_t>(first), memory_.values.end());
}

void Channel::scale(Carried& one, double factor) {
  for (std::vector<double>& change : one.changes)
    for (double& number : change) number *= factor;
}

void Channel::scale_changes(double factor) {
  scale(memory_, factor);
  for (Pending& pending : pending_) scale(pending.command, factor);
}

void Channel::measure(double t, const Carried& state) {
  if (!is_same_instant(next_tick(), t) && !(next_tick() < t)) return;
  if (!(next_tick() < end_) || is_same_instant(next_tick(), end_)) return;
  const double now = next_tick();
  fill_inputs(now, state, in_);
  add_noise(in_);
  round(in_);
  if (in_.values[attitude_at + 3] < 0.0)
    for (std::size_t i = attitude_at; i < attitude_at + 4; ++i) {
      in_.values[i] = -in_.values[i];
      for (std::vector<double>& error : in_.changes) error[i] = -error[i];
    }
  call(now, in_, out_);
  const std::size_t commands = controller_.count_commands(), first = memory_.values.size() - states_;
  if (spare_.empty()) spare_.emplace_back(commands, carrying_.count);
  Carried command = std::move(spare_.back());
  spare_.pop_back();
  std::copy_n(out_.values.begin(), commands, command.values.begin());
  for (std::size_t e = 0; e < carrying_.count; ++e) std::copy_n(out_.changes[e].begin(), commands, command.changes[e].begin());
  clip(command);
  const auto keep = [&](const std::vector<double>& from, std::vector<double>& to) {
    std::copy(from.begin() + static_cast<std::ptrdiff_t>(first), from.end(), to.begin() + static_cast<std::ptrdiff_t>(first));
  };
  keep(out_.values, memory_.values);
  for (std::size_t e = 0; e < carrying_.count; ++e) keep(out_.changes[e], memory_.changes[e]);
  if (keep_ticks_) record(now, command);
  pending_.push_back({now + controller_.parts().delay, std::move(command)});
  ++tick_;
}

}  // namespace polhode
