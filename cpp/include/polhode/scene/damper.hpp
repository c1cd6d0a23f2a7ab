#pragma once

#include <string>

#include "polhode/core/quat.hpp"
#include "polhode/torque/formula.hpp"

namespace polhode {

/// A viscous slug: a sphere in a cavity of the body, full of a viscous fluid (Kane's damper).
///
/// With Jd its moment, sigma its rates relative to the body and c the damping (Kane and Levinson 1985, Dynamics: Theory
/// and Applications; Hughes 1986, Spacecraft Attitude Dynamics, sec. 3.7):
///     (J - Jd 1) w' = tau + c sigma - w x (J - Jd 1) w
///     Jd (sigma' + w' + w x sigma) = -c sigma
/// Its momentum p = Jd (w + sigma) is a state of the scene: p' = -c sigma - w x p.
class Damper {
 public:
  /// @param inertia  Jd, of the sphere about its centre [kg m^2]
  /// @param viscous  c [N m s]
  /// @param rates    sigma at the start, body axes [rad/s]
  /// @throws InvalidInput for a moment that is not positive, a negative damping, and numbers that are not finite
  Damper(double inertia, double viscous, const Vector3d& rates = Vector3d::Zero());

  double inertia() const { return inertia_; }
  double viscous() const { return viscous_; }
  const Vector3d& rates() const { return rates_; }   ///< at the start
  /// The name of its momentum among the states of a scene; "" before the damper is in one.
  const std::string& state() const { return state_; }
  Damper with_state(std::string name) const;

 private:
  double inertia_, viscous_;
  Vector3d rates_;
  std::string state_;
};

/// The torque c sigma on the body, with the momentum p as a state.
torques::Formula make_torque(const Damper& damper, const Vector3d& momentum);

}  // namespace polhode
