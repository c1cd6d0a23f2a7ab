#pragma once

#include <vector>

#include "polhode/scene/scene.hpp"

// A piece of a body that changes, as a body of constant inertia with formulas as torques.
namespace polhode {

/// What a scene of constant inertia has in place of a piece of a body that changes.
struct ConstantBody {
  InertiaTensor inertia_B;           ///< rotors and the damper included, where they stay
  std::vector<AnyTorque> torques;
  std::vector<Rotor> rotors;
  bool keeps_damper = true;
};

/// A piece without change has its momentum in rotors that are held. Where h alone changes, h x w - h' is a torque more.
/// Where J changes, the equation J w' = tau + (J w + h) x w - J' w - h' is one of a body with the inertia J0 that J has
/// at a time `reference`: each torque tau becomes J0 J^-1 tau, and J0 J^-1 ((J w + h) x w - J' w - h') - J0 w x w is
/// one more. Then at that time nothing but J' and h' is added to Euler's equations. J w' stands without J' w if matter
/// leaves. J^-1 is the adjugate over the determinant.
/// @param torques  without windows
/// @param rotors   those that rotate, with their momentum
ConstantBody make_constant(const Scene& scene, const BodyPiece& body, double reference,
                           std::vector<AnyTorque> torques, std::vector<Rotor> rotors);

}  // namespace polhode
