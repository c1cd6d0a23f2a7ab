#pragma once

#include <memory>
#include <string>
#include <vector>

#include "polhode/core/state.hpp"
#include "polhode/inertia/inertia_tensor.hpp"
#include "polhode/torque/torques.hpp"

namespace polhode {

/// The quantities to return at each time.
struct Wanted {
  bool omega = true;
  bool attitude = true;
  friend bool operator==(const Wanted&, const Wanted&) = default;
};

/// The parts of a scene, to be filled by name.
struct SceneParts {
  InertiaTensor inertia_B;                       ///< about the centre of mass, or about the pivot of a body held at one
  Vector3d omega = Vector3d::Zero();             ///< w_B at t0 [rad/s]
  Quat attitude = {};                            ///< q_WB at t0
  std::vector<AnyTorque> torques = {};
  std::vector<double> times = {};                ///< where the answer is wanted, in any order, before or after t0 [s]
  Wanted want = {};
  double t0 = 0.0;                               ///< time of the start [s]
  std::string name = {};
};

/// What there is: a body, its start, its torques, and what is wanted. Checked here, once, and never changed; copies
/// share their parts.
class Scene {
 public:
  /// @throws InvalidInput, naming what is wrong, for a body that cannot turn (a moment of zero), a start or times that
  ///         are not finite, no times at all, or nothing wanted
  explicit Scene(SceneParts parts);

  const InertiaTensor& inertia_B() const { return parts_->inertia_B; }
  const Vector3d& omega() const { return parts_->omega; }
  const Quat& attitude() const { return parts_->attitude; }
  const std::vector<AnyTorque>& torques() const { return parts_->torques; }
  const std::vector<double>& times() const { return parts_->times; }
  const Wanted& want() const { return parts_->want; }
  double t0() const { return parts_->t0; }
  const std::string& name() const { return parts_->name; }

  State start() const { return {parts_->t0, parts_->omega, parts_->attitude}; }
  /// What all torques together depend on and keep.
  const TorqueSum& torque_sum() const { return torque_sum_; }
  /// A copy of all parts, for a scene that differs in some of them.
  SceneParts parts() const { return *parts_; }

 private:
  std::shared_ptr<const SceneParts> parts_;
  TorqueSum torque_sum_;
};

}  // namespace polhode
