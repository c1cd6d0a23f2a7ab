#pragma once

#include "polhode/torque/record.hpp"
#include "polhode/torque/vertical.hpp"

namespace polhode::torques {

/// A torque whose components are constant, in body axes (a thruster) or in space axes.
class Constant {
 public:
  enum class Frame { body, space };

  explicit Constant(const Vector3d& torque, Frame frame = Frame::body);

  static const TorqueRecord& record();
  static Constant from_values(std::span<const TorqueValue> values);
  TorqueValues values() const;

  const Vector3d& torque() const { return torque_; }
  Frame frame() const { return frame_; }

  /// The same torque as a formula of its parameters.
  formula::Program law(const Matrix3d& inertia_B) const;

  TorqueTraits traits() const {
    return {.uses_attitude = frame_ == Frame::space,
            .keeps_vertical = frame_ == Frame::space && torque_[2] == 0.0,
            .vanishes = torque_.isZero(0.0)};
  }

  /// tau_B += the torque [N m]
  void add(const TorqueInput& in, double* tau_B) const {
    double v[3] = {torque_[0], torque_[1], torque_[2]};
    if (frame_ == Frame::space) to_body(in.attitude, torque_.data(), v);
    for (int i = 0; i < 3; ++i) tau_B[i] += v[i];
  }

  double compute_potential(const TorqueInput&) const { return 0.0; }   ///< it has none: see traits()

 private:
  Vector3d torque_;
  Frame frame_;
};

}  // namespace polhode::torques
