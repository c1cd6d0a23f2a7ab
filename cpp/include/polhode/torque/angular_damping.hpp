#pragma once

#include "polhode/torque/formulas.hpp"
#include "polhode/torque/record.hpp"

namespace polhode::torques {

/// Damping proportional to the angular momentum: tau_B = -c I w_B. Beside the gyroscopic term, w' = ... - c w.
class AngularDamping {
 public:
  /// @param rate  c [1/s]; a negative rate drives the body
  explicit AngularDamping(double rate);

  static const TorqueRecord& record();
  static AngularDamping from_values(std::span<const TorqueValue> values);
  TorqueValues values() const { return {rate_}; }

  double rate() const { return rate_; }
  /// c I, the matrix of the same torque as Damping [N m s]
  Matrix3d compute_matrix(const Matrix3d& inertia_B) const { return rate_ * inertia_B; }

  /// The same torque as a formula of its parameters.
  formula::Program law(const Matrix3d& inertia_B) const;

  TorqueTraits traits() const { return {.uses_rates = true, .vanishes = rate_ == 0.0}; }

  void add(const TorqueInput& in, double* tau_B) const {
    add_damping(compute_matrix(in.inertia_B).data(), in.omega, tau_B);
  }

  double compute_potential(const TorqueInput&) const { return 0.0; }   ///< it has none: see traits()

 private:
  double rate_;
};

}  // namespace polhode::torques
