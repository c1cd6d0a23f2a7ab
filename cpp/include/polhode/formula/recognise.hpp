#pragma once

#include <vector>

#include "polhode/core/quat.hpp"
#include "polhode/formula/program.hpp"

namespace polhode::formula {

/// A torque with a closed name, found in a formula.
struct KnownTorque {
  enum class Kind {
    constant_in_body,    ///< vector [N m]
    constant_in_space,   ///< vector, space axes [N m]
    damping,             ///< -matrix w
    angular_damping,     ///< -rate I w
    rotors,              ///< vector x w: a constant momentum in the body [N m s]
    gravity,             ///< -vector x R^T e_z: weight times arm [N m]
    gravity_gradient     ///< 3 rate^2 u x (I u), u = R^T (cos a, sin a, 0), a = rate t + phase
  };
  Kind kind;
  Vector3d vector = Vector3d::Zero();
  Matrix3d matrix = Matrix3d::Zero();
  double rate = 0.0, phase = 0.0;
};

struct Recognition {
  std::vector<KnownTorque> parts;
  /// What is left of the torque, and the rates of its own states.
  Program rest;
  /// The rest of the torque vanishes identically, but for the rounding of its coefficients.
  bool is_whole = false;
};

/// Expands a torque as a polynomial in w and q modulo |q| = 1, up to degree 4, and finds the built-in torques in it.
/// Terms that are no such polynomials stay in the rest. Parameters must be bound. A torque that is identically zero is
/// whole and has no parts.
Recognition recognise(const Program& torque, const Matrix3d& inertia_B);

}  // namespace polhode::formula
