#pragma once

#include <cstddef>
#include <string>

#include "polhode/core/state.hpp"
#include "polhode/exact/detail/free_kernels.hpp"
#include "polhode/inertia/inertia_tensor.hpp"

namespace polhode {

/// How a plane pendulum moves.
enum class PendulumKind {
  rest,        ///< hanging or upright, without rotation
  swinging,    ///< to and fro about the hanging position
  rotating,    ///< over the top, always the same way round
  separatrix,  ///< with the energy of the upright position exactly: it approaches it for ever
};

const char* to_text(PendulumKind kind);   ///< the names above

/// The plane pendulum: any body on a pivot under gravity along -z of space that swings about one of its body axes.
///
/// In closed form at any time and energy. The axis is principal and horizontal, at right angles to the arm, and omega
/// lies along it. These conditions are tested exactly. See docs/pendulum.md. Immutable.
class Pendulum {
 public:
  /// @param inertia   I_B about the pivot [kg m^2]
  /// @param weight    m g [N]
  /// @param arm       r, from the pivot to the centre of mass, body axes [m]
  /// @param omega     w_B at t = 0 [rad/s]
  /// @param attitude  q_WB at t = 0
  /// @throws InvalidInput for values that are not finite, and for a body that is no plane pendulum, with the reason
  Pendulum(const InertiaTensor& inertia, double weight, const Vector3d& arm, const Vector3d& omega,
           const Quat& attitude = {});

  /// "" if the constructor takes these finite values, else the reason in words.
  static std::string refuse(const InertiaTensor& inertia, double weight, const Vector3d& arm, const Vector3d& omega,
                            const Quat& attitude);

  State at(double t) const;
  /// n states: omega 3 n and attitude 4 n numbers, row by row; either pointer may be null.
  void at(const double* t, std::size_t n, double* omega, double* attitude) const;

  PendulumKind kind() const { return kind_; }
  double period() const;                       ///< of theta' [s]: infinite on the separatrix, 0 at rest
  Vector3d axis() const { return axis_; }      ///< of rotation in body axes, with omega along it
  double frequency() const;                    ///< of small swings, sqrt(m g |r| / I) [rad/s]

  const InertiaTensor& inertia() const { return inertia_; }   ///< about the pivot
  double weight() const { return weight_; }
  const Vector3d& arm() const { return arm_; }
  const Vector3d& omega() const { return omega_; }
  const Quat& attitude() const { return attitude_; }

  friend bool operator==(const Pendulum& a, const Pendulum& b) {
    return a.inertia_ == b.inertia_ && a.weight_ == b.weight_ && a.arm_ == b.arm_ && a.omega_ == b.omega_ &&
           a.attitude_ == b.attitude_;
  }

 private:
  void set_up(int axis);

  InertiaTensor inertia_;
  double weight_;
  Vector3d arm_, omega_;
  Quat attitude_;
  Vector3d axis_ = Vector3d::Zero();
  PendulumKind kind_ = PendulumKind::rest;
  bool hyper_form_ = false;
  int rate_exponent_ = 0;                  ///< rates = 2^e rates'
  double half_sine_ = 0.0, half_cosine_ = 1.0;   ///< of theta / 2 at the start
  double frequency_ = 0.0;                 ///< scaled
  double longest_ = 0.0;                   ///< |t| of 1e25 rad
  exact::FreeTrig<double> trig_;
  exact::FreeHyper<double> hyper_;
  exact::FreeFrame frame_{};               ///< gives sin(theta / 2), cos(theta / 2), theta' in place of omega
};

}  // namespace polhode
