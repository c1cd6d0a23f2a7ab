#pragma once

#include "polhode/torque/law.hpp"

namespace polhode::torques {

template <class T>
struct GravityGradientNumbers {
  T mean_motion;
  T phase;
  static auto list(auto& of) { return std::tie(of.mean_motion, of.phase); }
};

/// Gravity gradient on a circular orbit about space z: tau_B = 3 n^2 u x (I u), u = R_WB^T (cos a, sin a, 0), a = n t +
/// phase.
class GravityGradient : public Law<GravityGradient, GravityGradientNumbers> {
 public:
  static constexpr TorqueParameter parameters[] = {
      {"mean_motion", TorqueParameter::Kind::real, "rad/s",
       "n, the rate of the circular orbit, which lies in the plane z = 0 of space"},
      {"phase", TorqueParameter::Kind::real, "rad", "the orbit angle from space x at t = 0", "0"},
  };
  static constexpr TorqueRecord about{
      "GravityGradient", "gravity_gradient",
      "Gravity gradient on a circular orbit: tau_B = 3 n^2 u x (I u), u = R_WB^T (cos a, sin a, 0), a = n t + phase.",
      "Hughes 1986, Spacecraft Attitude Dynamics, sec. 8.1", parameters};

  using Law::Law;
  /// @param mean_motion  n, the orbit's angular rate [rad/s]
  /// @param phase        the orbit angle at t = 0 [rad]
  explicit GravityGradient(double mean_motion, double phase = 0.0)
      : Law(GravityGradientNumbers<double>{mean_motion, phase}) {}

  static auto compute(const auto& in, const auto& p) {
    return in.cross_inertia(3.0 * p.mean_motion * p.mean_motion, in.radial(p.mean_motion * in.t + p.phase));
  }
  /// Up to the constant -n^2 tr(I)/2.
  static auto potential(const auto& in, const auto& p) {
    const auto u = in.radial(p.mean_motion * in.t + p.phase);
    return 1.5 * p.mean_motion * p.mean_motion * dot(u, in.inertia() * u);
  }

  double mean_motion() const { return numbers().mean_motion; }
  double phase() const { return numbers().phase; }
  double strength() const { return 3 * mean_motion() * mean_motion(); }   ///< 3 n^2 [1/s^2]

  TorqueTraits traits() const {
    return {.uses_time = true,
            .uses_attitude = true,
            .has_potential = true,
            .pattern_rate = mean_motion(),
            .vanishes = mean_motion() == 0.0};
  }
  formula::KnownTorque known() const {
    return {.kind = formula::KnownTorque::Kind::gravity_gradient, .rate = mean_motion(), .phase = phase()};
  }
};

}  // namespace polhode::torques
