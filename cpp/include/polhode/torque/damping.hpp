#pragma once

#include "polhode/torque/formulas.hpp"
#include "polhode/torque/record.hpp"

namespace polhode::torques {

/// Linear damping: tau_B = -C w_B with any constant matrix C.
class Damping {
 public:
  /// @param matrix  C, body axes [N m s]
  explicit Damping(const Matrix3d& matrix);

  static const TorqueRecord& record();
  static Damping from_values(std::span<const TorqueValue> values);
  TorqueValues values() const { return {matrix_}; }

  const Matrix3d& matrix() const { return matrix_; }

  /// The same torque as a formula of its parameters.
  formula::Program law(const Matrix3d& inertia_B) const;

  TorqueTraits traits() const { return {.uses_rates = true, .vanishes = matrix_.isZero(0.0)}; }

  void add(const TorqueInput& in, double* tau_B) const { add_damping(matrix_.data(), in.omega, tau_B); }

  double compute_potential(const TorqueInput&) const { return 0.0; }   ///< it has none: see traits()

 private:
  Matrix3d matrix_;
};

}  // namespace polhode::torques
