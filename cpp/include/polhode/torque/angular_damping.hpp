#pragma once

#include "polhode/torque/law.hpp"

namespace polhode::torques {

template <class T>
struct AngularDampingNumbers {
  T rate;
  static auto list(auto& of) { return std::tie(of.rate); }
};

/// Damping proportional to the angular momentum: tau_B = -c I w_B. Beside the gyroscopic term, w' = ... - c w.
class AngularDamping : public Law<AngularDamping, AngularDampingNumbers> {
 public:
  static constexpr TorqueParameter parameters[] = {
      {"rate", TorqueParameter::Kind::real, "1/s",
       "c, the rate at which the angular momentum decays; a negative rate drives the body"},
  };
  static constexpr TorqueRecord about{"AngularDamping", "angular_damping",
                                      "Damping proportional to the angular momentum: tau_B = -c I w_B.",
                                      "angularDamping of the physics engines; docs/damped_free.md", parameters};

  using Law::Law;
  /// @param rate  c [1/s]; a negative rate drives the body
  explicit AngularDamping(double rate) : Law(AngularDampingNumbers<double>{rate}) {}

  static auto compute(const auto& in, const auto& p) { return -((p.rate * in.inertia()) * in.omega); }

  double rate() const { return numbers().rate; }
  /// c I, the matrix of the same torque as Damping [N m s]
  Matrix3d compute_matrix(const Matrix3d& inertia_B) const { return rate() * inertia_B; }

  TorqueTraits traits() const { return {.uses_rates = true, .vanishes = rate() == 0.0}; }
  formula::KnownTorque known() const { return {.kind = formula::KnownTorque::Kind::angular_damping, .rate = rate()}; }
};

}  // namespace polhode::torques
