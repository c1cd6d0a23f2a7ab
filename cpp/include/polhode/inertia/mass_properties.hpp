#pragma once

#include <cstddef>

#include "polhode/inertia/inertia_tensor.hpp"

namespace polhode {

/// Mass, centre of mass and inertia of a body, in axes B from an origin B. Motion depends on nothing else of a shape.
class MassProperties {
 public:
  /// `inertia` is the tensor about the centre of mass, in axes B. Throws InvalidInput unless mass > 0 [kg].
  MassProperties(double mass, const Vector3d& com_B, const InertiaTensor& inertia_B);

  /// Point masses [kg], all positive, at positions (3 numbers each) [m].
  static MassProperties from_points(const double* masses, const double* positions_B, std::size_t count);

  /// The body with this mass [kg], centre of mass and tensor about the point `about_B`, all in axes B. Throws
  /// InvalidInput when no body has them.
  static MassProperties from_tensor(double mass, const Vector3d& com_B, const InertiaTensor& inertia_B,
                                    const Vector3d& about_B = Vector3d::Zero());

  double mass() const { return mass_; }                      ///< [kg]
  const Vector3d& com() const { return com_B_; }             ///< from the origin, in axes B [m]
  const InertiaTensor& inertia() const { return inertia_; }  ///< about the centre of mass, in axes B

  /// Inertia about another point, given from the origin in axes B: the parallel axes theorem.
  InertiaTensor about(const Vector3d& point_B) const;

  /// The same body in axes A: its point p_B moves to R_AB p_B + p_A.
  MassProperties moved(const Quat& q_AB, const Vector3d& p_A) const;

  /// Both bodies together. Both are given in the same axes, from the same origin.
  friend MassProperties operator+(const MassProperties& a, const MassProperties& b);
  /// Body a without body b. Throws InvalidInput when the rest is no body.
  friend MassProperties operator-(const MassProperties& a, const MassProperties& b);

  friend bool operator==(const MassProperties& a, const MassProperties& b) {
    return a.mass_ == b.mass_ && a.com_B_ == b.com_B_ && a.inertia_ == b.inertia_;
  }

 private:
  double mass_;
  Vector3d com_B_;
  InertiaTensor inertia_;
};

}  // namespace polhode
