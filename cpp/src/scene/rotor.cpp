#include "polhode/scene/rotor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "polhode/core/error.hpp"
#include "scene/rotor_torque.hpp"

namespace polhode {
namespace {

void require_finite(const char* where, const std::optional<double>& value) {
  if (value && !std::isfinite(*value)) throw InvalidInput(where, "finite", to_text(*value));
}

/// The axis as a unit vector. An axis that is unit to rounding keeps its bits.
bool scale_axis(Vector3d& axis) {
  for (int i = 0; i < 3; ++i) {
    if (!std::isfinite(axis[i])) {
      throw InvalidInput("Rotor.axis", "finite", to_text(axis[i]) + " in component " + std::to_string(i));
    }
  }
  const double largest = axis.cwiseAbs().maxCoeff();
  if (largest == 0.0) throw InvalidInput("Rotor.axis", "a direction", "(0, 0, 0)", "a zero vector has no direction");
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  if (std::abs(axis.squaredNorm() - 1.0) <= rounding) return false;
  for (double& x : axis) x = std::ldexp(x, -std::ilogb(largest));   // squares of 1e200 overflow, 2^1030 for 1e-310
  axis /= std::sqrt(axis.squaredNorm());
  return true;
}

/// Refuses numbers that say too little, or the same twice.
void require_enough(const RotorParts& parts) {
  if (parts.momentum && parts.speed) {
    throw InvalidInput("Rotor.momentum", "left out beside a speed", to_text(*parts.momentum),
                       parts.inertia ? "inertia and speed give the momentum already"
                                     : "give inertia with the speed, or the momentum alone");
  }
  if (parts.momentum) return;
  if (!parts.inertia && !parts.speed) {
    throw InvalidInput("Rotor.momentum", "given, or inertia and speed in its place", "none of them");
  }
  if (!parts.inertia) {
    throw InvalidInput("Rotor.inertia", "given with a speed", "the speed alone",
                       "the momentum is the inertia about the axis times the speed");
  }
  if (!parts.speed) {
    throw InvalidInput("Rotor.speed", "given with an inertia", "the inertia alone", "a locked rotor has speed = 0");
  }
}

bool has_drive(const RotorParts& parts) {
  return parts.law || parts.torque != 0.0 || parts.viscous != 0.0 || parts.coulomb != 0.0;
}

void require_not_negative(const char* where, double value) {
  if (!(value >= 0.0 && std::isfinite(value))) throw InvalidInput(where, "zero or positive, and finite", to_text(value));
}

void require_positive(const char* where, const std::optional<double>& value) {
  if (value && !(*value > 0.0 && std::isfinite(*value)))
    throw InvalidInput(where, "positive and finite", to_text(*value));
}

/// Checks the motor and the friction of a rotor.
void require_drive(const RotorParts& parts) {
  require_finite("Rotor.torque", parts.torque);
  require_not_negative("Rotor.viscous", parts.viscous), require_not_negative("Rotor.coulomb", parts.coulomb);
  require_positive("Rotor.max_torque", parts.max_torque), require_positive("Rotor.max_speed", parts.max_speed);
  const bool motor = parts.law || parts.torque != 0.0;
  if (parts.law && parts.torque != 0.0)
    throw InvalidInput("Rotor.torque", "a number or a formula, one of them", "both");
  if (parts.max_torque && !motor)
    throw InvalidInput("Rotor.max_torque", "left out without a motor's torque", to_text(*parts.max_torque));
  if (parts.max_speed && !motor)
    throw InvalidInput("Rotor.max_speed", "left out without a motor's torque", to_text(*parts.max_speed));
  if (parts.max_speed && parts.law && !parts.max_torque)
    throw InvalidInput("Rotor.max_torque", "given with a max_speed of a motor's formula", "none",
                       "it is what the motor can brake with at its top speed");
  if (parts.max_speed && parts.speed && !(std::abs(*parts.speed) <= *parts.max_speed))
    throw InvalidInput("Rotor.speed", "at most max_speed, " + to_text(*parts.max_speed), to_text(*parts.speed));
  if (parts.law) require_motor(*parts.law);
  if (!has_drive(parts)) return;
  const char* what = motor ? "Rotor.torque" : parts.viscous != 0.0 ? "Rotor.viscous" : "Rotor.coulomb";
  const std::string value = parts.law ? parts.law->torque : to_text(motor ? parts.torque : parts.viscous + parts.coulomb);
  if (!parts.free)
    throw InvalidInput(what, "left out for a rotor that is held", value, "its speed is constant; give free=True");
  if (!parts.inertia)
    throw InvalidInput(what, "given with an inertia", value, "the speed is the momentum over the inertia");
}

}  // namespace

Rotor::Rotor(RotorParts parts) : parts_(std::move(parts)) {
  axis_was_scaled_ = scale_axis(parts_.axis);
  require_finite("Rotor.momentum", parts_.momentum);
  require_finite("Rotor.inertia", parts_.inertia);
  require_finite("Rotor.speed", parts_.speed);
  if (parts_.inertia && !(*parts_.inertia > 0.0)) {
    throw InvalidInput("Rotor.inertia", "positive", to_text(*parts_.inertia),
                       "the sense of rotation is the sign of the speed or the momentum");
  }
  require_enough(parts_);
  if (parts_.inertia && parts_.speed && !std::isfinite(*parts_.inertia * *parts_.speed)) {
    throw InvalidInput("Rotor.speed", "such that inertia times speed is finite", to_text(*parts_.speed));
  }
  require_drive(parts_);
  if (!parts_.windows) return;
  if (parts_.free) {
    throw InvalidInput("Rotor.during", "left out with free=True", std::to_string(parts_.windows->size()) + " windows",
                       "a rotor that is free on its bearing always rotates; its motor may be a formula of the time");
  }
  parts_.windows = torques::arrange(std::move(*parts_.windows), "Rotor.during");
}

bool Rotor::is_driven() const { return has_drive(parts_) || !command_.empty(); }

Rotor Rotor::with_command(std::string name) const {
  Rotor other = *this;
  other.command_ = std::move(name);
  return other;
}

Rotor Rotor::with_state(std::string name) const {
  Rotor other = *this;
  other.state_ = std::move(name);
  return other;
}

Rotor Rotor::without_windows() const {
  Rotor other = *this;
  other.parts_.windows.reset();
  return other;
}

double Rotor::compute_start_momentum(const Vector3d& w_B) const {
  if (parts_.momentum) return *parts_.momentum;
  return *parts_.inertia * (parts_.free ? *parts_.speed + parts_.axis.dot(w_B) : *parts_.speed);
}

double Rotor::compute_speed(double momentum, const Vector3d& w_B) const {
  if (!parts_.inertia) return std::numeric_limits<double>::quiet_NaN();
  if (!parts_.free && parts_.speed && command_.empty()) return *parts_.speed;
  const double total = momentum / *parts_.inertia;
  return parts_.free ? total - parts_.axis.dot(w_B) : total;
}

bool Rotor::rotates_at(double t) const {
  if (!has_windows()) return true;
  return std::any_of(windows().begin(), windows().end(),
                     [t](const torques::Window& window) { return window.begin <= t && t < window.end; });
}

bool Rotor::rotates_throughout(double begin, double end) const {
  if (!has_windows()) return true;
  return std::any_of(windows().begin(), windows().end(), [=](const torques::Window& window) {
    return window.begin <= begin && end <= window.end;
  });
}

Vector3d sum_momenta(const std::vector<Rotor>& rotors, const Vector3d& w_B) {
  Vector3d sum = Vector3d::Zero();
  for (const Rotor& rotor : rotors) sum += rotor.compute_momentum(w_B) * rotor.axis();
  return sum;
}

}  // namespace polhode
