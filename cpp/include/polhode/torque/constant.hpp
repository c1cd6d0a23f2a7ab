#pragma once

#include "polhode/torque/law.hpp"

namespace polhode::torques {

template <class T>
struct ConstantNumbers {
  Vec<T, 3> torque;
  Choice frame;
  static auto list(auto& of) { return std::tie(of.torque, of.frame); }
};

/// A torque whose components are constant, in body axes (a thruster) or in space axes.
class Constant : public Law<Constant, ConstantNumbers> {
 public:
  enum class Frame { body, space };

  static constexpr TorqueParameter parameters[] = {
      {"torque", TorqueParameter::Kind::vector, "N m", "its components in the frame named"},
      {"frame", TorqueParameter::Kind::choice, "", "the axes in which the components are constant", "body",
       "body|space"},
  };
  static constexpr TorqueRecord about{
      "Constant", "constant", "A torque with constant components, in body axes (a thruster) or in space axes.",
      "Goldstein, Poole, Safko 2002, Classical Mechanics, sec. 5.5", parameters};

  using Law::Law;
  explicit Constant(const Vector3d& torque, Frame frame = Frame::body)
      : Law(ConstantNumbers<double>{formula::make_vector<double>(torque), {static_cast<int>(frame)}}) {}

  static auto compute(const auto& in, const auto& p) {
    return p.frame.number == static_cast<int>(Frame::body) ? p.torque : in.to_body(p.torque);
  }

  Vector3d torque() const { return to_eigen(numbers().torque); }
  Frame frame() const { return static_cast<Frame>(numbers().frame.number); }

  TorqueTraits traits() const {
    const bool in_space = frame() == Frame::space;
    return {.uses_attitude = in_space,
            .keeps_vertical = in_space && torque()[2] == 0.0,
            .vanishes = torque().isZero(0.0)};
  }
  formula::KnownTorque known() const {
    using Kind = formula::KnownTorque::Kind;
    return {.kind = frame() == Frame::body ? Kind::constant_in_body : Kind::constant_in_space, .vector = torque()};
  }
};

}  // namespace polhode::torques
