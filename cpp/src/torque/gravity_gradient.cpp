#include "polhode/torque/gravity_gradient.hpp"

#include "checks.hpp"
#include "polhode/formula/trace.hpp"

namespace polhode::torques {

GravityGradient::GravityGradient(double mean_motion, double phase) : mean_motion_(mean_motion), phase_(phase) {
  require_finite("GravityGradient.mean_motion", &mean_motion_, 1);
  require_finite("GravityGradient.phase", &phase_, 1);
}

const TorqueRecord& GravityGradient::record() {
  using Kind = TorqueParameter::Kind;
  static constexpr TorqueParameter parameters[] = {
      {"mean_motion", Kind::real, "rad/s", "n, the rate of the circular orbit, which lies in the plane z = 0 of space"},
      {"phase", Kind::real, "rad", "the orbit angle from space x at t = 0", "0"},
  };
  static constexpr TorqueRecord record{
      "GravityGradient", "gravity_gradient",
      "Gravity gradient on a circular orbit: tau_B = 3 n^2 u x (I u), u = R_WB^T (cos a, sin a, 0), a = n t + phase.",
      "Hughes 1986, Spacecraft Attitude Dynamics, sec. 8.1", parameters};
  return record;
}

GravityGradient GravityGradient::from_values(std::span<const TorqueValue> values) {
  return GravityGradient(std::get<double>(values[0]), std::get<double>(values[1]));
}

formula::Program GravityGradient::law(const Matrix3d& inertia_B) const {
  return formula::trace([&](const auto& in) {
    const auto n = in.p("mean_motion");
    const auto angle = n * in.t + in.p("phase");
    const formula::Vec<formula::Expr, 3> radial{{cos(angle), sin(angle), 0.0}};
    const auto u = to_body(in.attitude, radial);
    return 3.0 * n * n * cross(u, formula::apply_matrix(inertia_B, u));
  }, {{"mean_motion", {mean_motion_}}, {"phase", {phase_}}});
}

}  // namespace polhode::torques
