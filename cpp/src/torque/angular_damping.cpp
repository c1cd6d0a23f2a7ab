#include "polhode/torque/angular_damping.hpp"

#include "checks.hpp"
#include "polhode/formula/trace.hpp"

namespace polhode::torques {

AngularDamping::AngularDamping(double rate) : rate_(rate) { require_finite("AngularDamping.rate", &rate_, 1); }

const TorqueRecord& AngularDamping::record() {
  using Kind = TorqueParameter::Kind;
  static constexpr TorqueParameter parameters[] = {
      {"rate", Kind::real, "1/s", "c, the rate at which the angular momentum decays; a negative rate drives the body"},
  };
  static constexpr TorqueRecord record{"AngularDamping", "angular_damping",
                                       "Damping proportional to the angular momentum: tau_B = -c I w_B.",
                                       "angularDamping of the physics engines; docs/damped_free.md", parameters};
  return record;
}

AngularDamping AngularDamping::from_values(std::span<const TorqueValue> values) {
  return AngularDamping(std::get<double>(values[0]));
}

formula::Program AngularDamping::law(const Matrix3d& inertia_B) const {
  return formula::trace([&](const auto& in) { return -in.p("rate") * formula::apply_matrix(inertia_B, in.omega); },
                        {{"rate", {rate_}}});
}

}  // namespace polhode::torques
