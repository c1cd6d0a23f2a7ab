#pragma once

#include "polhode/torque/law.hpp"

namespace polhode::torques {

template <class T>
struct GravityNumbers {
  T weight;
  Vec<T, 3> arm;
  static auto list(auto& of) { return std::tie(of.weight, of.arm); }
};

/// Uniform gravity along -z of space, on a body held at a pivot: tau_B = r x (-m g R_WB^T e_z).
class Gravity : public Law<Gravity, GravityNumbers> {
 public:
  static constexpr TorqueParameter parameters[] = {
      {"weight", TorqueParameter::Kind::real, "N", "m g; gravity points along -z of space"},
      {"arm", TorqueParameter::Kind::vector, "m", "from the pivot to the centre of mass, in body axes"},
  };
  static constexpr TorqueRecord about{
      "Gravity", "gravity", "Uniform gravity on a body held at a pivot: tau_B = arm x (-weight R_WB^T e_z).",
      "Goldstein, Poole, Safko 2002, Classical Mechanics, sec. 5.7", parameters};

  explicit Gravity(const GravityNumbers<double>& numbers) : Law(numbers) {
    detail::require_finite("Gravity: weight times arm", moment().data(), 3);
  }
  /// @param weight  m g [N]
  /// @param arm     r, from the pivot to the centre of mass, body axes [m]
  Gravity(double weight, const Vector3d& arm)
      : Gravity(GravityNumbers<double>{weight, formula::make_vector<double>(arm)}) {}

  static auto compute(const auto& in, const auto& p) { return -cross(p.weight * p.arm, in.vertical()); }
  /// m g times the height of the centre of mass above the pivot
  static auto potential(const auto& in, const auto& p) { return dot(p.weight * p.arm, in.vertical()); }

  double weight() const { return numbers().weight; }
  Vector3d arm() const { return to_eigen(numbers().arm); }
  Vector3d moment() const { return weight() * arm(); }   ///< m g r [N m]

  TorqueTraits traits() const {
    return {.uses_attitude = true, .has_potential = true, .keeps_vertical = true, .vanishes = moment().isZero(0.0)};
  }
  formula::KnownTorque known() const { return {.kind = formula::KnownTorque::Kind::gravity, .vector = moment()}; }
};

}  // namespace polhode::torques
