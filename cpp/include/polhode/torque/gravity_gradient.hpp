#pragma once

#include <cmath>

#include "polhode/torque/record.hpp"
#include "polhode/torque/vertical.hpp"

namespace polhode::torques {

/// Gravity gradient on a circular orbit about space z: tau_B = 3 n^2 u x (I u), u = R_WB^T (cos a, sin a, 0), a = n t + phase.
class GravityGradient {
 public:
  /// @param mean_motion  n, the orbit's angular rate [rad/s]
  /// @param phase        the orbit angle at t = 0 [rad]
  explicit GravityGradient(double mean_motion, double phase = 0.0);

  static const TorqueRecord& record();
  static GravityGradient from_values(std::span<const TorqueValue> values);
  TorqueValues values() const { return {mean_motion_, phase_}; }

  double mean_motion() const { return mean_motion_; }
  double phase() const { return phase_; }

  TorqueTraits traits() const {
    return {.uses_time = true, .uses_attitude = true, .has_potential = true, .pattern_rate = mean_motion_};
  }

  void add(const TorqueInput& in, double* tau_B) const {
    double u[3], h[3];
    compute_radial(in, u);
    apply(in.inertia_B, u, h);
    const double s = 3 * mean_motion_ * mean_motion_;
    tau_B[0] += s * (u[1] * h[2] - u[2] * h[1]);
    tau_B[1] += s * (u[2] * h[0] - u[0] * h[2]);
    tau_B[2] += s * (u[0] * h[1] - u[1] * h[0]);
  }

  /// (3/2) n^2 u . I u, up to the constant -n^2 tr(I)/2 [J]
  double compute_potential(const TorqueInput& in) const {
    double u[3], h[3];
    compute_radial(in, u);
    apply(in.inertia_B, u, h);
    return 1.5 * mean_motion_ * mean_motion_ * (u[0] * h[0] + u[1] * h[1] + u[2] * h[2]);
  }

 private:
  void compute_radial(const TorqueInput& in, double* u_B) const {
    const double angle = mean_motion_ * in.t + phase_;
    const double u_W[3] = {std::cos(angle), std::sin(angle), 0.0};
    to_body(in.attitude, u_W, u_B);
  }
  static void apply(const Matrix3d& I, const double* u, double* h) {
    for (int i = 0; i < 3; ++i) h[i] = I(i, 0) * u[0] + I(i, 1) * u[1] + I(i, 2) * u[2];
  }

  double mean_motion_;
  double phase_;
};

}  // namespace polhode::torques
