#pragma once

#include <string_view>

#include "polhode/core/quat.hpp"

namespace polhode {

/// The largest entry of |R^T R - 1| that is still taken for a rotation matrix with rounding in it.
inline constexpr double kOrthogonalityTolerance = 1e-6;

/// q_WB of a rotation matrix R_WB; the largest of the four components decides the formula (Shepperd 1978,
/// J. Guidance and Control 1, 223), so that none is divided by a small number.
/// A matrix orthogonal within 1e-6 is replaced by the nearest rotation (its polar factor), which changes a valid
/// one by rounding only; any other, and one with a determinant <= 0, is refused, with `where` as its name.
Quat quat_from_matrix(const Matrix3d& R_WB, std::string_view where = "matrix");

}  // namespace polhode
