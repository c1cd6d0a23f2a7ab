#include "polhode/torque/constant.hpp"

#include "checks.hpp"
#include "polhode/formula/trace.hpp"

namespace polhode::torques {

Constant::Constant(const Vector3d& torque, Frame frame) : torque_(torque), frame_(frame) {
  require_finite("Constant.torque", torque.data(), 3);
}

const TorqueRecord& Constant::record() {
  using Kind = TorqueParameter::Kind;
  static constexpr TorqueParameter parameters[] = {
      {"torque", Kind::vector, "N m", "its components in the frame named"},
      {"frame", Kind::choice, "", "the axes in which the components are constant", "body", "body|space"},
  };
  static constexpr TorqueRecord record{
      "Constant", "constant", "A torque with constant components, in body axes (a thruster) or in space axes.",
      "Goldstein, Poole, Safko 2002, Classical Mechanics, sec. 5.5", parameters};
  return record;
}

Constant Constant::from_values(std::span<const TorqueValue> values) {
  return Constant(std::get<Vector3d>(values[0]),
                  std::get<std::string>(values[1]) == "body" ? Frame::body : Frame::space);
}

TorqueValues Constant::values() const { return {torque_, std::string(frame_ == Frame::body ? "body" : "space")}; }

formula::Program Constant::law(const Matrix3d&) const {
  return formula::trace([&](const auto& in) {
    const auto torque = in.template p<3>("torque");
    return frame_ == Frame::body ? torque : to_body(in.attitude, torque);
  }, {{"torque", {torque_[0], torque_[1], torque_[2]}}});
}

}  // namespace polhode::torques
