#pragma once

#include <optional>
#include <span>
#include <vector>

#include "polhode/core/quat.hpp"
#include "polhode/torque/during.hpp"

namespace polhode {

/// The parts of a rotor, to be filled by name. Two of momentum, inertia and speed are enough; momentum alone is, too.
struct RotorParts {
  Vector3d axis = Vector3d::UnitZ();          ///< body axes; only its direction counts
  std::optional<double> momentum = {};        ///< held: relative to the body; free: absolute, about the axis [N m s]
  std::optional<double> inertia = {};         ///< Js, moment about the axis [kg m^2]
  std::optional<double> speed = {};           ///< relative to the body at the start [rad/s]
  bool free = false;                          ///< free on its bearing, without a motor
  /// In which it rotates: always without a value, never with none of them.
  std::optional<std::vector<torques::Window>> windows = {};
};

/// A symmetric body that rotates about an axis fixed in the carrying body: a wheel, a propeller, a platform.
///
/// Euler's equations of the carrier are J w' + w x (J w + h) = tau. All rotors together give h (Wittenburg 1977,
/// Dynamics of Systems of Rigid Bodies, sec. 4.6).
/// - Held at a constant relative speed: J has the rotors locked, and h = sum Js speed a.
/// - Free on its bearing: J is less Js a a^T, and h = sum Js (speed + a.w) a at the start, which stays constant.
class Rotor {
 public:
  /// @throws InvalidInput for an axis that is zero or not finite, numbers that are not finite, a moment that is not
  ///         positive, too many or too few of momentum, inertia and speed, and windows of a free rotor
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

  /// Its momentum about the axis [N m s]: relative to the body, or absolute if it is free.
  double compute_momentum(const Vector3d& w_B) const;
  /// Its speed relative to the body [rad/s] at another rate of the body, for a known inertia; otherwise NaN.
  /// @param momentum  what compute_momentum gave at the start
  double compute_speed(double momentum, const Vector3d& w_B) const;

  bool rotates_at(double t) const;
  /// Whether it rotates from one time to a later one without a break.
  bool rotates_throughout(double begin, double end) const;

 private:
  RotorParts parts_;
  bool axis_was_scaled_ = false;
};

/// h_B of rotors that all rotate, for the rates of the body at the start.
Vector3d sum_momenta(const std::vector<Rotor>& rotors, const Vector3d& w_B);

}  // namespace polhode
