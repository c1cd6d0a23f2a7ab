#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "polhode/core/quat.hpp"
#include "polhode/torque/during.hpp"
#include "polhode/torque/formula.hpp"

namespace polhode {

/// The parts of a rotor, to be filled by name. Two of momentum, inertia and speed are enough; momentum alone is, too.
struct RotorParts {
  Vector3d axis = Vector3d::UnitZ();          ///< body axes; only its direction counts
  std::optional<double> momentum = {};        ///< held: relative to the body; free: absolute, about the axis [N m s]
  std::optional<double> inertia = {};         ///< Js, moment about the axis [kg m^2]
  std::optional<double> speed = {};           ///< relative to the body at the start [rad/s]
  bool free = false;                          ///< free on its bearing: no motor holds its speed
  /// In which it rotates: always without a value, never with none of them.
  std::optional<std::vector<torques::Window>> windows = {};
  double torque = 0.0;                        ///< of a motor, on the rotor about its axis, if it is constant [N m]
  /// The same as a formula in place of a number: its `torque` is one number, of t, omega, attitude, speed and its
  /// parameters. trace_motor() makes one of a generic callable.
  std::optional<formula::Text> law = {};
  double viscous = 0.0;                       ///< of the bearing [N m s]: -viscous speed on the rotor
  double coulomb = 0.0;                       ///< dry friction of the bearing [N m]
  std::optional<double> max_torque = {};      ///< the motor gives no more than this, in both senses [N m]
  std::optional<double> max_speed = {};       ///< the motor drives no further than this, in both senses [rad/s]
};

/// A symmetric body that rotates about an axis fixed in the carrying body: a wheel, a propeller, a platform.
///
/// Euler's equations of the carrier are J w' + w x (J w + h) = tau. All rotors together give h (Wittenburg 1977,
/// Dynamics of Systems of Rigid Bodies, sec. 4.6).
/// - Held at a constant relative speed: J has the rotors locked, and h = sum Js speed a.
/// - Free on its bearing: J is less Js a a^T, and h = sum Js (speed + a.w) a at the start, which stays constant.
/// - Driven: free, with a torque e about its axis from a motor and the bearing. Its momentum changes by h' = e
///   (Hughes 1986, Spacecraft Attitude Dynamics, sec. 3.4).
class Rotor {
 public:
  /// @throws InvalidInput for an axis that is zero or not finite, numbers that are not finite, a moment that is not
  ///         positive, too many or too few of momentum, inertia and speed, windows of a free rotor, and a motor or
  ///         friction of a rotor that is held or has no inertia
  explicit Rotor(RotorParts parts);

  const Vector3d& axis() const { return parts_.axis; }   ///< a, unit
  const std::optional<double>& momentum() const { return parts_.momentum; }
  const std::optional<double>& inertia() const { return parts_.inertia; }
  const std::optional<double>& speed() const { return parts_.speed; }
  bool free() const { return parts_.free; }
  bool has_windows() const { return parts_.windows.has_value(); }   ///< false: it always rotates
  /// Sorted by time, separate. A rotor that has windows, but none of them, never rotates.
  std::span<const torques::Window> windows() const {
    return has_windows() ? std::span<const torques::Window>(*parts_.windows) : std::span<const torques::Window>();
  }
  const RotorParts& parts() const { return parts_; }
  bool axis_was_scaled() const { return axis_was_scaled_; }   ///< the given axis was not a unit vector

  /// A motor or friction acts about its axis.
  bool is_driven() const;
  /// A driven rotor's momentum is a state of this name in a scene; "" before the rotor is in one.
  const std::string& state() const { return state_; }
  Rotor with_state(std::string name) const;
  /// Of a rotor that a controller drives: the name of the state that holds its torque if it is free, else any name. The
  /// momentum is then a state.
  const std::string& command() const { return command_; }
  Rotor with_command(std::string name) const;
  /// Without what a scene adds.
  Rotor as_given() const { return with_state("").with_command(""); }
  Rotor without_windows() const;

  /// Its momentum about the axis at the start [N m s]: relative to the body, or absolute if it is free.
  double compute_start_momentum(const Vector3d& w_B) const;
  /// The part of it that stays constant: nothing of a driven rotor.
  double compute_momentum(const Vector3d& w_B) const { return is_driven() ? 0.0 : compute_start_momentum(w_B); }
  /// Its speed relative to the body [rad/s] at another rate of the body, for a known inertia; otherwise NaN.
  /// @param momentum  what compute_start_momentum gave, or the state of a driven rotor
  double compute_speed(double momentum, const Vector3d& w_B) const;

  bool rotates_at(double t) const;
  /// Whether it rotates from one time to a later one without a break.
  bool rotates_throughout(double begin, double end) const;

 private:
  RotorParts parts_;
  bool axis_was_scaled_ = false;
  std::string state_, command_;
};

/// The torque on the carrier by a driven rotor with its momentum h as a state: -w x (h a) - e a, and h' = e. A held rotor
/// has e = 0: its controller changes h at once.
torques::Formula make_torque(const Rotor& rotor, double momentum);

/// What a motor's function is as text: `[](const auto& in) { return in.s("speed") * -in.p("k"); }`, where `in` is a
/// formula::TorqueArguments.
template <class Callable>
formula::Text trace_motor(const Callable& callable, std::vector<formula::Input> parameters = {});

/// A formula's text of the torque (u, 0, 0) with the state speed, as the text of the one number u.
formula::Text take_motor(formula::Text torque);

template <class Callable>
formula::Text trace_motor(const Callable& callable, std::vector<formula::Input> parameters) {
  const auto as_torque = [&](const auto& in) {
    const formula::Expr u = callable(in), none(0.0);
    return formula::TorqueResult<formula::Expr>{{{u, none, none}}, {none}};
  };
  return take_motor(formula::print(formula::trace(as_torque, std::move(parameters), {{"speed", {0.0}}})));
}

/// h_B of rotors that all rotate, for the rates of the body at the start.
Vector3d sum_momenta(const std::vector<Rotor>& rotors, const Vector3d& w_B);

}  // namespace polhode
