#pragma once

#include "polhode/torque/formulas.hpp"
#include "polhode/torque/record.hpp"

namespace polhode::torques {

/// Uniform gravity along -z of space, on a body held at a pivot: tau_B = r x (-m g R_WB^T e_z).
class Gravity {
 public:
  /// @param weight  m g [N]
  /// @param arm     r, from the pivot to the centre of mass, body axes [m]
  Gravity(double weight, const Vector3d& arm);

  static const TorqueRecord& record();
  static Gravity from_values(std::span<const TorqueValue> values);
  TorqueValues values() const { return {weight_, arm_}; }

  double weight() const { return weight_; }
  const Vector3d& arm() const { return arm_; }

  /// The same torque as a formula of its parameters.
  formula::Program law(const Matrix3d& inertia_B) const;

  TorqueTraits traits() const {
    return {.uses_attitude = true, .has_potential = true, .keeps_vertical = true, .vanishes = moment_.isZero(0.0)};
  }

  const Vector3d& moment() const { return moment_; }   ///< m g r [N m]

  void add(const TorqueInput& in, double* tau_B) const { add_weight(moment_.data(), in.attitude, tau_B); }

  /// m g times the height of the centre of mass above the pivot [J]
  double compute_potential(const TorqueInput& in) const {
    double g[3];
    compute_vertical(in.attitude, g);
    return moment_[0] * g[0] + moment_[1] * g[1] + moment_[2] * g[2];
  }

 private:
  double weight_;
  Vector3d arm_;
  Vector3d moment_;
};

}  // namespace polhode::torques
