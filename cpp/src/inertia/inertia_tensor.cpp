#include "polhode/inertia/inertia_tensor.hpp"

#include <algorithm>
#include <cmath>

#include "inertia/validation.hpp"
#include "polhode/core/error.hpp"

namespace polhode {
namespace {

Matrix3d diagonal(const Vector3d& d) {
  Matrix3d m = Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) m(i, i) = d[i];
  return m;
}

}  // namespace

InertiaTensor::InertiaTensor(const Matrix3d& I_B, bool physical)
    : InertiaTensor(inertia::symmetrized(I_B, "inertia"), physical, Trusted{}) {
  inertia::check_moments(I_B_, principal_, physical_, "inertia");
  principal_.moments = principal_.moments.cwiseMax(0.0);
}

InertiaTensor::InertiaTensor(const Matrix3d& I_B, bool physical, Trusted)
    : I_B_(I_B), principal_(compute_principal_axes(I_B)), physical_(physical) {}

InertiaTensor InertiaTensor::from_moments(const Vector3d& moments, bool physical) {
  return InertiaTensor(diagonal(moments), physical);
}

InertiaTensor InertiaTensor::from_trusted(const Matrix3d& I_B, bool physical) {
  InertiaTensor tensor(inertia::symmetrized(I_B, "inertia"), physical, Trusted{});
  tensor.principal_.moments = tensor.principal_.moments.cwiseMax(0.0);
  return tensor;
}

PrincipalAxes InertiaTensor::principal(double gap) const {
  if (!(gap >= 0 && gap < 1)) throw InvalidInput("gap", "a part of the largest moment, 0 to below 1", to_text(gap));
  PrincipalAxes result = compute_principal_axes(I_B_, gap);
  result.moments = result.moments.cwiseMax(0.0);
  return result;
}

double InertiaTensor::about_axis(const Vector3d& direction_B) const {
  const double size = direction_B.cwiseAbs().maxCoeff();
  if (!direction_B.allFinite() || size == 0) {
    throw InvalidInput("direction", "finite and not zero", inertia::vector_text(direction_B));
  }
  const Vector3d u = direction_B / size;
  return std::max(0.0, u.dot(I_B_ * u) / u.dot(u));
}

InertiaTensor InertiaTensor::rotated(const Quat& q_AB) const {
  const Matrix3d R_AB = to_matrix(make_attitude(q_AB));
  const Matrix3d I_A = R_AB * I_B_ * R_AB.transpose();
  return from_trusted(0.5 * I_A + 0.5 * I_A.transpose(), physical_);
}

bool InertiaTensor::is_diagonal() const { return I_B_(0, 1) == 0 && I_B_(0, 2) == 0 && I_B_(1, 2) == 0; }

bool InertiaTensor::is_positive_definite() const {
  return moments()[0] > (is_diagonal() ? 0.0 : symmetry_gap * moments()[2]);
}

}  // namespace polhode
