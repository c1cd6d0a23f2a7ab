#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "polhode/core/state.hpp"
#include "polhode/formula/program.hpp"
#include "polhode/formula/recognise.hpp"
#include "polhode/torque/during.hpp"
#include "polhode/torque/list.hpp"

namespace polhode {

namespace torques {
template <class One, class... Torques>
std::variant<Torques..., One> append(std::variant<Torques...>*);
}  // namespace torques

/// Any torque of the list, acting all the time or during windows of it.
using AnyTorque = decltype(torques::append<torques::During>(static_cast<LastingTorque*>(nullptr)));

/// What a set of torques together depends on and conserves.
struct TorqueSum {
  int acting = 0;                   ///< the number of torques that do not vanish
  bool uses_time = false;
  bool uses_attitude = false;
  bool uses_rates = false;
  bool rotors = false;              ///< rotors act, whose gyroscopic torque h x w does no work ...
  bool steady_rotors = true;        ///< ... and is constant: none of them starts or stops
  bool has_potential = true;        ///< all of them have one
  bool keeps_vertical = true;       ///< none has a component about space z
  bool keeps_energy = true;         ///< all potentials are fixed in space
  bool keeps_jacobi = false;        ///< all potentials rotate at pattern_rate: energy - pattern_rate L_z is constant
  double pattern_rate = 0.0;
};

/// Torques acting together, of any kinds, and the gyroscopic torque of rotors: one function for all that evaluates
/// them, compiled once.
struct SeveralTorques {
  const std::vector<AnyTorque>& torques;
  Vector3d rotor_momentum = Vector3d::Zero();   ///< h_B [N m s]
  bool any() const { return !torques.empty() || !rotor_momentum.isZero(0.0); }
  void add(const TorqueInput& in, double* tau_B) const;
};

/// The states of all formulas, with their starts, in the order of the torques. Formulas may share a state of one name
/// with equal starts and rates. @throws InvalidInput for two states of one name that differ
std::vector<formula::Input> list_states(std::span<const AnyTorque> torques);

/// A torque without windows, as one of any kind.
AnyTorque to_any(const LastingTorque& torque);

/// The torque without its windows.
LastingTorque drop_windows(const AnyTorque& torque);

/// The formula that a torque is, or that acts in its windows; null for torques with kernels, and for a Custom.
const torques::Formula* find_formula(const AnyTorque& torque);

/// The operation of a formula that has no derivatives at a state, in words; "" if there is none. Windows are left out.
/// @param near  how close to 0 an operand counts as 0
std::string find_singular(std::span<const AnyTorque> torques, const Matrix3d& inertia_B, const State& state,
                          double near);

/// What a torque with kernels is, by its numbers; nothing for others, and for a torque with windows.
std::optional<formula::KnownTorque> find_known(const AnyTorque& torque);
/// C_B of a torque with kernels that is -C_B w_B.
std::optional<Matrix3d> find_damping(const AnyTorque& torque, const Matrix3d& inertia_B);
/// Whether the law of a torque depends on the inertia.
bool uses_inertia(const AnyTorque& torque);
/// The derivative of a law's outputs by the inertia, for a change dI_B, with its parameters as numbers.
formula::Program make_inertia_slope(const AnyTorque& torque, const Matrix3d& inertia_B, const Matrix3d& dI_B);

/// A torque of the list as a formula of its parameters, without its windows. @throws InvalidInput for a Custom
formula::Program make_law(const AnyTorque& torque, const Matrix3d& inertia_B);

/// The same with the values of its parameters and of the inertia as the values of inputs: nothing is rounded together.
formula::Program make_open_law(const AnyTorque& torque, const Matrix3d& inertia_B);

/// The same with its parameters as numbers.
formula::Program make_bound_law(const AnyTorque& torque, const Matrix3d& inertia_B);

/// A torque of the list as a formula with its parameters, which solve() does not replace; without its windows.
/// @throws InvalidInput for a Custom
torques::Formula as_formula(const AnyTorque& torque, const Matrix3d& inertia_B);

TorqueTraits traits(const AnyTorque& torque);
std::string_view torque_name(const AnyTorque& torque);   ///< of its record
TorqueSum summarize(std::span<const AnyTorque> torques);
/// Adds the gyroscopic torque of rotors with a momentum that is not zero. `steady`: it is constant.
void add_rotors(TorqueSum& sum, bool steady);

}  // namespace polhode
