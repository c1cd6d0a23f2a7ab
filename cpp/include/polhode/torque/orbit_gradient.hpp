#pragma once

#include <cmath>

#include "polhode/torque/law.hpp"

namespace polhode::torques {

template <class T>
struct OrbitGradientNumbers {
  formula::Ephemeris orbit;
  static auto list(auto& of) { return std::tie(of.orbit); }
};

/// Gravity gradient on an orbit: tau_B = 3 mu / |r|^5 r x (I r), r = R_WB^T r_W. In Python it is GravityGradient(orbit=).
class OrbitGradient : public Law<OrbitGradient, OrbitGradientNumbers> {
 public:
  static constexpr TorqueParameter parameters[] = {
      {"orbit", TorqueParameter::Kind::orbit, "",
       "the path of the centre of mass about the attracting one, or of that one about the body"},
  };
  static constexpr TorqueRecord about{
      "OrbitGradient", "gravity_gradient",
      "Gravity gradient on an orbit: tau_B = 3 mu / |r|^5 r x (I r), r = R_WB^T r_W.",
      "Hughes 1986, Spacecraft Attitude Dynamics, sec. 8.1", parameters};

  using Law::Law;
  /// @throws InvalidInput for an orbit without mu
  explicit OrbitGradient(formula::Ephemeris orbit) : Law(OrbitGradientNumbers<double>{std::move(orbit)}) {}

  static void check(const OrbitGradientNumbers<double>& numbers) {
    if (!(numbers.orbit.mu() > 0.0))
      throw InvalidInput("GravityGradient.orbit", "an orbit with its mu", "one without", "give mu to Orbit.table");
  }
  static auto compute(const auto& in, const auto& p) {
    const auto seen = in.see(p.orbit);
    const auto u = seen.inverse_distance, u2 = u * u;
    return in.cross_inertia(3.0 * p.orbit.mu() * (u2 * u2 * u), in.to_body(seen.r));
  }
  /// Up to the constant -mu tr(I) / (2 |r|^3).
  static auto potential(const auto& in, const auto& p) {
    const auto seen = in.see(p.orbit);
    const auto r = in.to_body(seen.r);
    const auto u = seen.inverse_distance, u2 = u * u;
    return 1.5 * p.orbit.mu() * (u2 * u2 * u) * dot(r, in.inertia() * r);
  }

  const formula::Ephemeris& orbit() const { return numbers().orbit; }
};

}  // namespace polhode::torques
