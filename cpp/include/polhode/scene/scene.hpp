#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "polhode/clock/controller.hpp"
#include "polhode/core/state.hpp"
#include "polhode/inertia/inertia_tensor.hpp"
#include "polhode/scene/changing.hpp"
#include "polhode/scene/damper.hpp"
#include "polhode/scene/rotor.hpp"
#include "polhode/torque/torques.hpp"

namespace polhode {

/// The quantities to return at each time.
struct Wanted {
  bool omega = true;
  bool attitude = true;
  friend bool operator==(const Wanted&, const Wanted&) = default;
};

/// A torque in windows beside controllers: its torque times a state, which is 1 within the windows and 0 elsewhere.
struct HeldWindow {
  std::size_t torque;      ///< its number among all
  std::string state;
  torques::During during;  ///< as it was given
};

/// The parts of a scene, to be filled by name.
struct SceneParts {
  InertiaTensor inertia_B;                       ///< about the centre of mass, or about the pivot of a body held at
                                                 ///< one; of all, rotors included and locked. Of a body that
                                                 ///< changes, any tensor: that of t0 takes its place
  Vector3d omega = Vector3d::Zero();             ///< w_B at t0 [rad/s]
  Quat attitude = {};                            ///< q_WB at t0
  std::vector<AnyTorque> torques = {};
  std::vector<double> times = {};                ///< where the answer is wanted, in any order, before or after t0 [s]
  Wanted want = {};
  double t0 = 0.0;                               ///< time of the start [s]
  std::string name = {};
  std::vector<Rotor> rotors = {};                ///< in the body, in any number
  std::optional<Damper> damper = {};             ///< in the body
  std::optional<Changing> changing = {};         ///< the inertia, where it changes
  std::optional<Changing> momentum = {};         ///< h_B of parts that move within the body [N m s]
  bool leaving = false;                          ///< matter that leaves takes its momentum along
  std::vector<Controller> controllers = {};      ///< in the order of what they do at one instant
  std::vector<HeldWindow> held_windows = {};     ///< made where there are controllers
};

/// The inertia and the momentum of parts inside, in one piece of time of a body that changes.
///
/// With H = J w + h the angular momentum in body axes, H' = H x w + tau. Where J or h jumps, H stays and w jumps. If
/// matter leaves at rest relative to the body, it takes J' w along: J w' = H x w + tau - h', and w stays where J jumps.
struct BodyPiece {
  std::optional<Changing::Piece> inertia = {};    ///< J; nothing: that of the scene
  std::optional<Changing::Piece> momentum = {};   ///< h; nothing: zero
  bool is_constant() const {
    return (!inertia || inertia->is_constant()) && (!momentum || momentum->is_constant());
  }
};

/// What there is: a body with its rotors, its start, its torques, and what is wanted. Checked here, once, and never
/// changed; copies share their parts.
class Scene {
 public:
  /// @throws InvalidInput, naming what is wrong, for a body that cannot turn (a moment of zero), a start or times that
  ///         are not finite, no times at all, nothing wanted, or free rotors that leave no inertia to the body
  explicit Scene(SceneParts parts);

  /// The inertia J that moves with omega: the given one, less the axial moments of free rotors and the damper's.
  const InertiaTensor& inertia_B() const { return carrier_ ? *carrier_ : parts_->inertia_B; }
  const InertiaTensor& given_inertia_B() const { return parts_->inertia_B; }   ///< of all, rotors included and locked
  /// The inertia or the momentum of parts inside depends on time. inertia_B() is then that of t0.
  bool changes() const { return parts_->changing || parts_->momentum; }
  const std::optional<Changing>& changing() const { return parts_->changing; }
  const std::optional<Changing>& momentum() const { return parts_->momentum; }
  bool leaving() const { return parts_->leaving; }
  /// The inertia that moves with omega at a time, in the piece that holds from it on.
  Matrix3d inertia_B(double t) const;
  Matrix3d given_inertia_B(double t) const;
  /// What free rotors and the damper take from the inertia.
  const Matrix3d& inertia_reduction() const { return reduction_; }
  /// The momentum of parts inside at a time, without rotors.
  Vector3d inner_momentum(double t) const;
  /// The times within a span at which a piece of the body ends.
  std::vector<double> find_changes(double first, double last) const;
  /// The body's piece that holds from a time on, or up to it.
  BodyPiece find_body_piece(double t, bool before = false) const;
  const Vector3d& omega() const { return parts_->omega; }
  const Quat& attitude() const { return parts_->attitude; }
  /// The torques as given, and behind them those of driven rotors on the carrier and of controllers.
  const std::vector<AnyTorque>& torques() const { return parts_->torques; }
  std::vector<AnyTorque> given_torques() const;
  std::vector<Rotor> given_rotors() const;
  std::optional<Damper> given_damper() const;
  std::vector<Controller> given_controllers() const;
  /// No torque acts but those between the body and its rotors: the angular momentum in space is constant.
  bool is_closed() const;
  /// Rotors or a damper have momenta that are states.
  bool has_inner_states() const;
  const std::optional<Damper>& damper() const { return parts_->damper; }
  const std::vector<Controller>& controllers() const { return parts_->controllers; }
  const std::vector<HeldWindow>& held_windows() const { return parts_->held_windows; }
  const std::vector<double>& times() const { return parts_->times; }
  const Wanted& want() const { return parts_->want; }
  const std::vector<Rotor>& rotors() const { return parts_->rotors; }
  /// h_B, the sum of the rotors' momenta at the start [N m s].
  const Vector3d& rotor_momentum() const { return rotor_momentum_; }
  Vector3d rotor_momentum(double t) const;
  double t0() const { return parts_->t0; }
  const std::string& name() const { return parts_->name; }

  /// The states of the torques with their starts, in the order of all that holds their numbers.
  const std::vector<formula::Input>& states() const { return states_; }
  int count_states() const;   ///< numbers of all of them

  State start() const { return {parts_->t0, parts_->omega, parts_->attitude, formula::list_values(states_)}; }
  /// What all torques and rotors together depend on and keep.
  const TorqueSum& torque_sum() const { return torque_sum_; }
  /// All torques and rotors, to be evaluated together. It refers to this scene.
  SeveralTorques all_torques() const { return {parts_->torques, rotor_momentum_}; }
  /// A copy of all parts, for a scene that differs in some of them. Free rotors have the momentum of this start.
  SceneParts parts() const;
  /// The same scene with other torques. Free rotors keep what they were given by.
  Scene with_torques(std::vector<AnyTorque> torques) const;

 private:
  std::shared_ptr<const SceneParts> parts_;
  std::shared_ptr<const InertiaTensor> carrier_;   ///< null without free rotors and damper
  Matrix3d reduction_ = Matrix3d::Zero();
  Vector3d rotor_momentum_ = Vector3d::Zero();
  TorqueSum torque_sum_;
  std::vector<formula::Input> states_;
};

/// Gives the states of the torques other starts, in the order of list_states().
void set_starts(std::vector<AnyTorque>& torques, const std::vector<double>& starts);
/// The same in the order of `states`, which may have others besides.
void set_starts(std::vector<AnyTorque>& torques, const std::vector<formula::Input>& states,
                const std::vector<double>& starts);

/// The speeds of all rotors relative to the body [rad/s] in n states, as (n, rotors): of a free rotor as the body's
/// rates change it, of a held one constant, and 0 outside its windows. NaN for a rotor without an inertia.
/// @param omega   (n, 3), body axes
/// @param states  (n, count_states()), needed for driven rotors, which have NaN without it
void compute_rotor_speed(const Scene& scene, std::size_t n, const double* t, const double* omega, const double* states,
                         double* speed);

/// The rates of the damper relative to the body [rad/s] in n states, as (n, 3).
/// @param omega   (n, 3), body axes
/// @param states  (n, count_states())
/// @throws InvalidInput for a scene without a damper
void compute_damper_rates(const Scene& scene, std::size_t n, const double* omega, const double* states, double* rates);

/// The momentum in body axes of a scene's rotors and damper at a time.
/// @param states  count_states() numbers
Vector3d sum_momenta(const Scene& scene, double t, const double* states);
/// The energy of driven rotors, h^2 / 2 Js for each, and of the damper, p^2 / 2 Jd [J]. That of other rotors
/// is constant, and left out.
double sum_energies(const Scene& scene, const double* states);

}  // namespace polhode
