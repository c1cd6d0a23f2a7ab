#include "polhode/torque/gravity.hpp"

#include "checks.hpp"
#include "polhode/formula/trace.hpp"

namespace polhode::torques {

Gravity::Gravity(double weight, const Vector3d& arm) : weight_(weight), arm_(arm), moment_(weight * arm) {
  require_finite("Gravity.weight", &weight_, 1);
  require_finite("Gravity.arm", arm_.data(), 3);
  require_finite("Gravity: weight times arm", moment_.data(), 3);
}

const TorqueRecord& Gravity::record() {
  using Kind = TorqueParameter::Kind;
  static constexpr TorqueParameter parameters[] = {
      {"weight", Kind::real, "N", "m g; gravity points along -z of space"},
      {"arm", Kind::vector, "m", "from the pivot to the centre of mass, in body axes"},
  };
  static constexpr TorqueRecord record{
      "Gravity", "gravity", "Uniform gravity on a body held at a pivot: tau_B = arm x (-weight R_WB^T e_z).",
      "Goldstein, Poole, Safko 2002, Classical Mechanics, sec. 5.7", parameters};
  return record;
}

Gravity Gravity::from_values(std::span<const TorqueValue> values) {
  return Gravity(std::get<double>(values[0]), std::get<Vector3d>(values[1]));
}

formula::Program Gravity::law(const Matrix3d&) const {
  return formula::trace([&](const auto& in) {
    const auto vertical = to_body(in.attitude, formula::make_vector<formula::Expr>(Vector3d::UnitZ()));
    return -cross(in.p("weight") * in.template p<3>("arm"), vertical);
  }, {{"arm", {arm_[0], arm_[1], arm_[2]}}, {"weight", {weight_}}});
}

}  // namespace polhode::torques
