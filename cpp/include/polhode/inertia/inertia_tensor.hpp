#pragma once

#include "polhode/inertia/principal_axes.hpp"

namespace polhode {

/// The inertia tensor of a body about a stated point, in given axes B [kg m^2]: L_B = I_B w_B, so the products of
/// inertia stand in it with their minus sign, I_xy = -sum of m x y.
///
/// Checked at construction, by relative thresholds: finite, symmetric, no negative moment, and no moment above the sum
/// of the two others, which no distribution of mass can have. A rod (one zero moment) and a point (the zero tensor) are
/// valid.
class InertiaTensor {
 public:
  /// Errors that the checks allow, as a part of the largest entry or moment: those of rounding.
  static constexpr double tolerance = 1e-12;

  /// Throws InvalidInput, with the axis, the deficit in per cent and the likely cause. `physical = false` skips
  /// the triangle inequality alone, for published cases that violate it.
  explicit InertiaTensor(const Matrix3d& I_B, bool physical = true);

  /// From moments about the body axes, in their order; they need not be sorted.
  static InertiaTensor from_moments(const Vector3d& moments, bool physical = true);

  /// From a value that was checked before (rotated, read back): only symmetry is checked again.
  static InertiaTensor from_trusted(const Matrix3d& I_B, bool physical = true);

  const Matrix3d& matrix() const { return I_B_; }                 ///< I_B, exactly symmetric
  const Vector3d& moments() const { return principal_.moments; }  ///< principal moments, ascending
  const Matrix3d& axes() const { return principal_.axes; }        ///< R_BP: columns are the principal axes
  Symmetry symmetry() const { return principal_.symmetry; }       ///< by `symmetry_gap`
  bool physical() const { return physical_; }                     ///< whether the triangle inequality is required

  const PrincipalAxes& principal() const { return principal_; }
  PrincipalAxes principal(double gap) const;  ///< with the caller's gap, for data with fewer digits

  /// Moment about the line through the point of reference along a direction of any non-zero length.
  double about_axis(const Vector3d& direction_B) const;

  /// The same body in axes A: I_A = R_AB I_B R_AB^T.
  InertiaTensor rotated(const Quat& q_AB) const;

  bool is_diagonal() const;           ///< whether the given axes are exactly principal
  bool is_positive_definite() const;  ///< whether every moment is above rounding, as dynamics need

  friend bool operator==(const InertiaTensor& a, const InertiaTensor& b) { return a.I_B_ == b.I_B_; }

 private:
  struct Trusted {};
  InertiaTensor(const Matrix3d& I_B, bool physical, Trusted);

  Matrix3d I_B_;
  PrincipalAxes principal_;
  bool physical_;
};

}  // namespace polhode
