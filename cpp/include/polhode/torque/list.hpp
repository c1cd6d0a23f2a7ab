#pragma once

#include <variant>

#include "polhode/torque/angular_damping.hpp"
#include "polhode/torque/constant.hpp"
#include "polhode/torque/custom.hpp"
#include "polhode/torque/damping.hpp"
#include "polhode/torque/formula.hpp"
#include "polhode/torque/gravity.hpp"
#include "polhode/torque/gravity_gradient.hpp"
#include "polhode/torque/orbit_gradient.hpp"

namespace polhode {

/// The list of torques. To add a torque, write its law and name it here; all else follows.
using LastingTorque = std::variant<torques::Constant,         //
                                   torques::Gravity,          //
                                   torques::GravityGradient,  //
#ifndef POLHODE_WITHOUT_ORBITS   // as in the browser, whose scenes have none
                                   torques::OrbitGradient,    //
#endif
                                   torques::Damping,          //
                                   torques::AngularDamping,   //
                                   torques::Formula,          //
                                   torques::Custom>;

}  // namespace polhode
