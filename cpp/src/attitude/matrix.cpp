#include "polhode/attitude/matrix.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "attitude/rows.hpp"
#include "polhode/core/error.hpp"

namespace polhode {
namespace {

/// X <- X (3 - X^T X) / 2 converges quadratically to the polar factor (Higham 2008, Functions of Matrices, section
/// 8.3): a deviation of 1e-6 is 1e-24 after two steps.
Matrix3d nearest_rotation(const Matrix3d& R) {
  Matrix3d X = R;
  for (int step = 0; step < 2; ++step) X = 0.5 * X * (3.0 * Matrix3d::Identity() - X.transpose() * X);
  return X;
}

double determinant(const Matrix3d& R) {
  return R(0, 0) * (R(1, 1) * R(2, 2) - R(1, 2) * R(2, 1)) - R(0, 1) * (R(1, 0) * R(2, 2) - R(1, 2) * R(2, 0)) +
         R(0, 2) * (R(1, 0) * R(2, 1) - R(1, 1) * R(2, 0));
}

double deviation(const Matrix3d& R) {
  return (R.transpose() * R - Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

}  // namespace

bool try_quat_from_matrix(const Matrix3d& R_WB, Quat& q_WB) {
  const double excess = deviation(R_WB);
  if (!(excess <= kOrthogonalityTolerance) || !(determinant(R_WB) > 0.0)) return false;
  // Rounding alone (a few ulp) is left to the norm at the end.
  const Matrix3d R = excess > 4e-15 ? nearest_rotation(R_WB) : R_WB;

  // 4 q q^T has these diagonal entries; the row of the largest gives q up to its length.
  const double trace = R(0, 0) + R(1, 1) + R(2, 2);
  const double diagonal[4] = {R(0, 0), R(1, 1), R(2, 2), trace};
  const auto choice = std::max_element(diagonal, diagonal + 4) - diagonal;
  double q[4];
  if (choice == 3) {
    q[0] = R(2, 1) - R(1, 2), q[1] = R(0, 2) - R(2, 0), q[2] = R(1, 0) - R(0, 1), q[3] = 1.0 + trace;
  } else {
    const auto i = choice, j = (i + 1) % 3, k = (i + 2) % 3;
    q[i] = 1.0 + R(i, i) - R(j, j) - R(k, k);
    q[j] = R(j, i) + R(i, j), q[k] = R(k, i) + R(i, k), q[3] = R(k, j) - R(j, k);
  }
  const double n = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  q_WB = {q[0] / n, q[1] / n, q[2] / n, q[3] / n};
  return true;
}

Quat quat_from_matrix(const Matrix3d& R_WB, std::string_view where) {
  Quat q_WB;
  if (try_quat_from_matrix(R_WB, q_WB)) return q_WB;
  if (!R_WB.array().isFinite().all()) throw InvalidInput(where, "finite", "nan or inf");
  const double det = determinant(R_WB);
  if (!(det > 0.0)) {
    throw InvalidInput(where, "a rotation matrix, of determinant 1", "determinant " + to_text(det),
                       det < 0.0 ? "a left-handed frame: two axes swapped, or one reversed" : "dependent columns");
  }
  throw InvalidInput(where, "a rotation matrix, R^T R = 1 within 1e-6", "a deviation of " + to_text(deviation(R_WB)),
                     "scaled, sheared, or printed with too few digits");
}

}  // namespace polhode
