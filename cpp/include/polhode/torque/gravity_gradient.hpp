#pragma once

#include <cmath>

#include "polhode/torque/record.hpp"

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
    return {.uses_time = true,
            .uses_attitude = true,
            .has_potential = true,
            .pattern_rate = mean_motion_,
            .vanishes = mean_motion_ == 0.0};
  }

  void add(const TorqueInput& in, double* tau_B) const {
    double u[3], h[3];
    compute_radial(in, u);
    const double s = 3 * mean_motion_ * mean_motion_;
    const Matrix3d& I = in.inertia_B;
    if (in.principal) {
      tau_B[0] += s * (I(2, 2) - I(1, 1)) * (u[1] * u[2]);
      tau_B[1] += s * (I(0, 0) - I(2, 2)) * (u[2] * u[0]);
      tau_B[2] += s * (I(1, 1) - I(0, 0)) * (u[0] * u[1]);
      return;
    }
    apply(I, u, h);
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
    const double x = in.attitude[0], y = in.attitude[1], z = in.attitude[2], w = in.attitude[3];
    const double xx = x * x, yy = y * y, zz = z * z, ww = w * w;
    const double unit = 1.0 / (xx + yy + zz + ww);
    const double c = std::cos(angle) * unit, s = std::sin(angle) * unit;
    u_B[0] = c * (ww + xx - yy - zz) + s * (2 * (x * y + w * z));   // rows x and y of R_WB
    u_B[1] = c * (2 * (x * y - w * z)) + s * (ww - xx + yy - zz);
    u_B[2] = c * (2 * (x * z + w * y)) + s * (2 * (y * z - w * x));
  }
  static void apply(const Matrix3d& I, const double* u, double* h) {
    for (int i = 0; i < 3; ++i) h[i] = I(i, 0) * u[0] + I(i, 1) * u[1] + I(i, 2) * u[2];
  }

  double mean_motion_;
  double phase_;
};

}  // namespace polhode::torques
