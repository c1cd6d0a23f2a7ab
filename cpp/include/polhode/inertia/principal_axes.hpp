#pragma once

#include <cstddef>
#include <limits>

#include "polhode/core/quat.hpp"

namespace polhode {

/// Which principal moments coincide. Oblate (a coin): the largest stands apart; prolate (a needle): the smallest.
enum class Symmetry { spherical, oblate, prolate, triaxial };

/// Which directions are principal axes by the moments alone: those of the frame, any in a plane, or any.
enum class Arbitrary { none, plane, sphere };

const char* to_text(Symmetry symmetry);    ///< "spherical", "oblate", "prolate" or "triaxial"
const char* to_text(Arbitrary arbitrary);  ///< "none", "plane" or "sphere"

/// Moments closer than this part of the largest count as equal: what rounding leaves of equal moments when a tensor
/// is turned once or twice. Data with fewer digits need a wider gap, given by the caller.
inline constexpr double symmetry_gap = 16 * std::numeric_limits<double>::epsilon();

/// Moments, ascending, and the principal axes that belong to them.
///
/// The columns of `axes` (R_BP) are the principal axes P in the given axes B, right-handed, in the order of the
/// moments. That order leaves only signs, and these rules choose them:
/// - the axes of the smallest and of the largest moment point towards the given axis they lie nearest to (their largest
///   component is positive; of components equal to 1e-6 the first counts), the middle one completes the frame.
///   So a tensor whose principal frame is the given one turned by less than 45 degrees has just that frame, a diagonal
///   tensor has a signed permutation, and no axis flips while it stays within 45 degrees of a given axis;
/// - two equal moments: the axis that stands apart as above; the two others are the given axes carried along by the
///   smallest turn that takes the given axis nearest to it onto it;
/// - three equal moments: the given axes themselves.
struct PrincipalAxes {
  Vector3d moments = Vector3d::Zero();      ///< ascending [kg m^2]
  Matrix3d axes = Matrix3d::Identity();     ///< R_BP
  Symmetry symmetry = Symmetry::spherical;  ///< by the gap asked for

  /// Two equal moments leave every direction in the plane across `normal()` arbitrary, three every direction.
  Arbitrary arbitrary() const;
  /// The axis that stands apart, in the given axes; zero unless exactly two moments coincide.
  Vector3d normal() const;

  friend bool operator==(const PrincipalAxes& a, const PrincipalAxes& b) {
    return a.moments == b.moments && a.axes == b.axes && a.symmetry == b.symmetry;
  }
};

/// Principal axes of a symmetric, finite matrix (its lower triangle is not read), in given axes B.
/// Jacobi's rotations; moments and residuals accurate to a few units of rounding of the largest moment, at any scale.
PrincipalAxes compute_principal_axes(const Matrix3d& I_B, double gap = symmetry_gap);

/// The same as InertiaTensor finds, bit for bit, for `count` matrices of 9 numbers each: moments (3 each), axes (9
/// each, row by row). Only symmetry is asked for, as at InertiaTensor's door: negative moments, too, have their axes.
/// A matrix that is not finite gives NaN; returns how many did. Throws InvalidInput for one that is not symmetric.
std::size_t compute_principal_axes(const double* I_B, std::size_t count, double* moments, double* axes);

}  // namespace polhode
