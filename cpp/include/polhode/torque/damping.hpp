#pragma once

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

  TorqueTraits traits() const { return {.uses_rates = true, .vanishes = matrix_.isZero(0.0)}; }

  void add(const TorqueInput& in, double* tau_B) const {
    for (int i = 0; i < 3; ++i) {
      tau_B[i] -= matrix_(i, 0) * in.omega[0] + matrix_(i, 1) * in.omega[1] + matrix_(i, 2) * in.omega[2];
    }
  }

  double compute_potential(const TorqueInput&) const { return 0.0; }   ///< it has none: see traits()

 private:
  Matrix3d matrix_;
};

}  // namespace polhode::torques
