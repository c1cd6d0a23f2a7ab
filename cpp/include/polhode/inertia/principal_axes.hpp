#pragma once

#include <cstddef>
#include <limits>

#include "polhode/core/quat.hpp"

namespace polhode {

/// Which principal moments coincide. Oblate (a coin): the largest is distinct; prolate (a needle): the smallest.
enum class Symmetry { spherical, oblate, prolate, triaxial };

/// Which directions are principal: those of the frame alone, any in a plane, or any.
enum class Arbitrary { none, plane, sphere };

const char* to_text(Symmetry symmetry);    ///< "spherical", "oblate", "prolate" or "triaxial"
const char* to_text(Arbitrary arbitrary);  ///< "none", "plane" or "sphere"

/// Moments closer than this part of the largest count as equal. Equal moments differ by so much after a tensor was
/// rotated once or twice. Data with fewer digits need a wider gap, given by the caller.
inline constexpr double symmetry_gap = 16 * std::numeric_limits<double>::epsilon();

/// Moments, ascending, and the principal axes that belong to them.
///
/// The columns of `axes` (R_BP) are the principal axes P in the given axes B, right-handed, in the order of the
/// moments. Three rules choose the signs, and the axes of equal moments:
/// - The axes of the smallest and of the largest moment point towards the nearest given axis: their largest component
///   is positive (of components equal to 1e-6 the first counts). The middle axis completes the frame. So a frame within
///   45 degrees of the given one is found as it is, a diagonal tensor has a signed permutation, and no axis flips while
///   it stays within 45 degrees of a given axis.
/// - With two equal moments the axis of the third is chosen as above. The two others are the given axes under the
///   smallest rotation that takes the given axis nearest to the third onto it.
/// - With three equal moments the axes are the given ones.
struct PrincipalAxes {
  Vector3d moments = Vector3d::Zero();      ///< ascending [kg m^2]
  Matrix3d axes = Matrix3d::Identity();     ///< R_BP
  Symmetry symmetry = Symmetry::spherical;  ///< by the requested gap

  /// Two equal moments make all directions perpendicular to `normal()` principal, three equal moments all directions.
  Arbitrary arbitrary() const;
  /// The axis of the distinct moment, in the given axes; zero unless exactly two moments are equal.
  Vector3d normal() const;

  friend bool operator==(const PrincipalAxes& a, const PrincipalAxes& b) {
    return a.moments == b.moments && a.axes == b.axes && a.symmetry == b.symmetry;
  }
};

/// Principal axes of a symmetric, finite matrix (its lower triangle is not read), in given axes B.
/// Jacobi's rotations; moments and residuals accurate to a few units of rounding of the largest moment, at any scale.
PrincipalAxes compute_principal_axes(const Matrix3d& I_B, double gap = symmetry_gap);

/// Moments (3 each) and axes (9 each, row by row) of `count` matrices of 9 numbers each, with the bits of
/// InertiaTensor. Only symmetry is checked, and negative moments are accepted. A matrix that is not finite gives NaN.
/// Returns the number of such matrices. Throws InvalidInput for a matrix that is not symmetric.
std::size_t compute_principal_axes(const double* I_B, std::size_t count, double* moments, double* axes);

}  // namespace polhode
