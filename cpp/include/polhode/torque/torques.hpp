#pragma once

#include <array>
#include <variant>

#include "polhode/torque/constant.hpp"
#include "polhode/torque/custom.hpp"
#include "polhode/torque/damping.hpp"
#include "polhode/torque/gravity.hpp"
#include "polhode/torque/gravity_gradient.hpp"

namespace polhode {

/// The list of torques. A new one is a file of its own and a name here; bindings, scene files, docs and tests follow.
using AnyTorque = std::variant<torques::Constant,         //
                               torques::Gravity,          //
                               torques::GravityGradient,  //
                               torques::Damping,          //
                               torques::Custom>;

/// What a set of torques acting together depends on and keeps.
struct TorqueSum {
  int acting = 0;                   ///< how many of them do not vanish
  bool uses_time = false;
  bool uses_attitude = false;
  bool uses_rates = false;
  bool has_potential = true;        ///< every one of them has
  bool keeps_vertical = true;       ///< none has a component about space z
  bool keeps_energy = true;         ///< potentials that all stand still
  bool keeps_jacobi = false;        ///< potentials that all turn at pattern_rate: energy - pattern_rate L_z stays
  double pattern_rate = 0.0;
};

TorqueTraits traits(const AnyTorque& torque);
TorqueSum summarize(std::span<const AnyTorque> torques);

}  // namespace polhode
