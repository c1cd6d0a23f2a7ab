#pragma once

#include <cmath>

#include "polhode/math/detail/functions.hpp"
#include "polhode/math/detail/sincos_unfused.hpp"
#include "polhode/torque/formulas.hpp"
#include "polhode/torque/record.hpp"

namespace polhode::torques {

/// Gravity gradient on a circular orbit about space z: tau_B = 3 n^2 u x (I u), u = R_WB^T (cos a, sin a, 0), a = n t +
/// phase.
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
  double strength() const { return 3 * mean_motion_ * mean_motion_; }   ///< 3 n^2 [1/s^2]

  /// The same torque as a formula of its parameters.
  formula::Program law(const Matrix3d& inertia_B) const;

  TorqueTraits traits() const {
    return {.uses_time = true,
            .uses_attitude = true,
            .has_potential = true,
            .pattern_rate = mean_motion_,
            .vanishes = mean_motion_ == 0.0};
  }

  void add(const TorqueInput& in, double* tau_B) const {
    double u[3];
    compute_radial(in, u);
    if (in.principal) {
      add_gradient<true>(strength(), in.inertia_B.data(), u, tau_B);
    } else {
      add_gradient<false>(strength(), in.inertia_B.data(), u, tau_B);
    }
  }

  /// (3/2) n^2 u . I u, up to the constant -n^2 tr(I)/2 [J]
  double compute_potential(const TorqueInput& in) const {
    double u[3];
    compute_radial(in, u);
    const double* I = in.inertia_B.data();
    return 1.5 * mean_motion_ * mean_motion_ *
           (u[0] * row_product(I, 0, u) + u[1] * row_product(I, 1, u) + u[2] * row_product(I, 2, u));
  }

 private:
  void compute_radial(const TorqueInput& in, double* u_B) const {
    const double angle = mean_motion_ * in.t + phase_;
    double sine, cosine;
    if (std::abs(angle) <= math::most_unfused_angle) {
      math::sincos_unfused(angle, sine, cosine);   // the same bits for bodies in lanes
    } else {
      const math::SinCosPair far = math::sincos(angle);
      sine = far.sin, cosine = far.cos;
    }
    polhode::compute_radial(cosine, sine, in.attitude, u_B);
  }

  double mean_motion_;
  double phase_;
};

}  // namespace polhode::torques
