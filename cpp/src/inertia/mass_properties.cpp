#include "polhode/inertia/mass_properties.hpp"

#include <limits>
#include <string>

#include "inertia/validation.hpp"
#include "polhode/core/error.hpp"

namespace polhode {
namespace {

/// The moment of a point mass at d about the origin: m (d.d 1 - d d^T), without cancellation on the diagonal.
Matrix3d point_inertia(double m, const Vector3d& d) {
  Matrix3d I;
  I << m * (d[1] * d[1] + d[2] * d[2]), -m * d[0] * d[1], -m * d[0] * d[2],  //
      -m * d[0] * d[1], m * (d[0] * d[0] + d[2] * d[2]), -m * d[1] * d[2],   //
      -m * d[0] * d[2], -m * d[1] * d[2], m * (d[0] * d[0] + d[1] * d[1]);
  return I;
}

double largest(const Matrix3d& m) { return m.cwiseAbs().maxCoeff(); }

}  // namespace

MassProperties::MassProperties(double mass, const Vector3d& com_B, const InertiaTensor& inertia_B)
    : mass_(inertia::positive(mass, "mass")), com_B_(com_B), inertia_(inertia_B) {
  if (!com_B.allFinite()) throw InvalidInput("com", "finite", inertia::vector_text(com_B));
}

MassProperties MassProperties::from_points(const double* masses, const double* positions_B, std::size_t count) {
  if (count == 0) throw InvalidInput("masses", "one or more masses", "none");
  double mass = 0;
  // Relative to the first point, so that a distant origin costs no digits.
  Vector3d first_moment = Vector3d::Zero();
  const auto position = [&](std::size_t i) { return Vector3d(Eigen::Map<const Vector3d>(positions_B + 3 * i)); };
  for (std::size_t i = 0; i < count; ++i) {
    const std::string where = "masses[" + std::to_string(i) + "]";
    mass += inertia::positive(masses[i], where.c_str());
    first_moment += masses[i] * (position(i) - position(0));
  }
  const Vector3d com_from_first = first_moment / mass;
  Matrix3d I = Matrix3d::Zero();
  for (std::size_t i = 0; i < count; ++i) I += point_inertia(masses[i], position(i) - position(0) - com_from_first);
  return MassProperties(mass, position(0) + com_from_first, InertiaTensor(I));
}

MassProperties MassProperties::from_tensor(double mass, const Vector3d& com_B, const InertiaTensor& inertia_B,
                                           const Vector3d& about_B) {
  if (!com_B.allFinite()) throw InvalidInput("com", "finite", inertia::vector_text(com_B));
  if (!about_B.allFinite()) throw InvalidInput("about", "finite", inertia::vector_text(about_B));
  const Matrix3d shift = point_inertia(inertia::positive(mass, "mass"), about_B - com_B);
  const Matrix3d I = inertia_B.matrix() - shift;
  const double rounding =
      16 * std::numeric_limits<double>::epsilon() * (largest(inertia_B.matrix()) + largest(shift));
  inertia::check_moments(I, compute_principal_axes(I), inertia_B.physical(), "inertia about the centre of mass",
                         rounding, "a tensor about the centre of mass already, or about another point?");
  return MassProperties(mass, com_B, InertiaTensor::from_trusted(I, inertia_B.physical()));
}

InertiaTensor MassProperties::about(const Vector3d& point_B) const {
  if (!point_B.allFinite()) throw InvalidInput("point", "finite", inertia::vector_text(point_B));
  return InertiaTensor::from_trusted(inertia_.matrix() + point_inertia(mass_, point_B - com_B_), inertia_.physical());
}

MassProperties MassProperties::moved(const Quat& q_AB, const Vector3d& p_A) const {
  if (!p_A.allFinite()) throw InvalidInput("translation", "finite", inertia::vector_text(p_A));
  return MassProperties(mass_, rotate(make_attitude(q_AB), com_B_) + p_A, inertia_.rotated(q_AB));
}

MassProperties operator+(const MassProperties& a, const MassProperties& b) {
  const double mass = a.mass_ + b.mass_, part = b.mass_ / mass;
  const Vector3d d = b.com_B_ - a.com_B_;
  const Matrix3d I = a.inertia_.matrix() + b.inertia_.matrix() + point_inertia(a.mass_ * part, d);
  return MassProperties(mass, a.com_B_ + part * d,
                        InertiaTensor::from_trusted(I, a.inertia_.physical() && b.inertia_.physical()));
}

MassProperties operator-(const MassProperties& a, const MassProperties& b) {
  constexpr const char* cause = "a hole bigger than the body, outside it, or of another density?";
  const double mass = a.mass_ - b.mass_;
  if (!(mass > 0)) throw InvalidInput("difference", "a body of positive mass", to_text(mass), cause);
  const double part = b.mass_ / mass;
  const Vector3d d = b.com_B_ - a.com_B_;
  const Matrix3d shift = point_inertia(a.mass_ * part, d);
  const Matrix3d I = a.inertia_.matrix() - b.inertia_.matrix() - shift;
  const bool physical = a.inertia_.physical() && b.inertia_.physical();
  // The rounding of the subtraction. A small difference of the masses magnifies the part of the shift.
  const double rounding = 16 * std::numeric_limits<double>::epsilon() *
                          (largest(a.inertia_.matrix()) + largest(b.inertia_.matrix()) + (1 + part) * largest(shift));
  inertia::check_moments(I, compute_principal_axes(I), physical, "difference", rounding, cause);
  return MassProperties(mass, a.com_B_ - part * d, InertiaTensor::from_trusted(I, physical));
}

}  // namespace polhode
