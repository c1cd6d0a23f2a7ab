#pragma once

#include <cstddef>
#include <vector>

#include "polhode/core/state.hpp"
#include "polhode/exact/detail/free_kernels.hpp"
#include "polhode/inertia/inertia_tensor.hpp"

namespace polhode {

/// How a free body moves, decided at construction.
enum class FreeKind {
  rest,            ///< omega = 0
  spherical,       ///< three equal moments: omega is constant
  steady,          ///< rotation about a principal axis, stable or not: omega is constant
  oblate,          ///< two equal moments below the third: regular precession
  prolate,         ///< two equal moments above the third: regular precession
  about_least,     ///< three moments, omega encircles the axis of the least
  about_greatest,  ///< three moments, omega encircles the axis of the greatest
  separatrix,      ///< three moments, L^2 = 2 T I2 exactly: one flip in all time
};

/// "rest", "spherical", "steady", "oblate", "prolate", "about_least", "about_greatest" or "separatrix".
const char* to_text(FreeKind kind);

/// Torque-free motion of any rigid body about its centre of mass (or a fixed point), in closed form at any time.
///
/// The error against the exact motion from the same float64 input is a few units of rounding. That holds in every
/// regime and at every time up to |omega t| = 1e25 rad. See docs/exact.md.
class FreeMotion {
 public:
  /// I_B, w_B(0) [rad/s] and q_WB(0). Throws InvalidInput, also for a body without a moment about some axis.
  FreeMotion(const InertiaTensor& inertia, const Vector3d& omega, const Quat& attitude = {});

  /// The same from principal moments in the body axes, in any order.
  FreeMotion(const Vector3d& moments, const Vector3d& omega, const Quat& attitude = {});

  State at(double t) const;

  /// n states: omega 3 n and attitude 4 n numbers, row by row; either pointer may be null.
  void at(const double* t, std::size_t n, double* omega, double* attitude) const;
  /// The same at times that were analysed before.
  void at(const exact::TimeGrid& times, double* omega, double* attitude) const;

  FreeKind kind() const { return kind_; }
  double period() const;            ///< of omega [s]; infinite on the separatrix, 0 where omega is constant
  double precession_rate() const;   ///< mean rate about the angular momentum [rad/s]
  double energy() const;            ///< T [J]
  Vector3d angular_momentum() const;  ///< L_W [kg m^2 / s], constant

  /// (phi, theta, psi), intrinsic z-x-z, of the body axes in a space frame whose z axis is the angular momentum
  /// (space z rotated to it the shortest way): precession, nutation, spin. Throws InvalidInput for a body at rest.
  Vector3d euler_angles(double t) const;
  Vector3d polhode(double t) const;     ///< omega / sqrt(2 T) in body axes: Poinsot's point on the inertia ellipsoid
  Vector3d herpolhode(double t) const;  ///< the same point in space axes: it runs in the plane L . v = sqrt(2 T)

  /// The times in [begin, end] at which the component of omega along the intermediate axis is zero: the middle of each
  /// flip. Empty unless the three moments differ and the motion is not steady.
  std::vector<double> flip_times(double begin, double end) const;

  const InertiaTensor& inertia() const { return inertia_; }
  const Vector3d& omega() const { return omega_; }          ///< w_B(0)
  const Quat& attitude() const { return attitude_; }        ///< q_WB(0)

  friend bool operator==(const FreeMotion& a, const FreeMotion& b) {
    return a.inertia_ == b.inertia_ && a.omega_ == b.omega_ && a.attitude_ == b.attitude_;
  }

 private:
  friend class DampedFree;   // the same motion in another time
  enum class Form { rest, intermediate, trig, hyper };

  void set_up(const Vector3d& moments, const Matrix3d& R_BP, bool exact_axes);
  void classify(const Vector3d& I, const Vector3d& w, bool exact_axes);
  double checked_time(double t) const;  ///< t in scaled units
  Vector3d momentum_direction() const;
  void write_constant(const double* t, std::size_t n, double* omega, double* attitude) const;

  InertiaTensor inertia_;
  Vector3d omega_;
  Quat attitude_;
  FreeKind kind_ = FreeKind::rest;
  Form form_ = Form::rest;
  int time_exponent_ = 0, moment_exponent_ = 0;  ///< omega = 2^e omega', moments likewise
  double longest_ = 0.0;                         ///< |t'| of 1e25 rad
  double twice_T_ = 0.0, L_ = 0.0, precession_ = 0.0;  ///< scaled
  exact::FreeTrig<double> trig_;
  exact::FreeHyper<double> hyper_;
  exact::FreeFrame frame_{};
};

}  // namespace polhode
