#pragma once

#include <cstddef>
#include <optional>

#include "polhode/exact/detail/gyrostat_series.hpp"
#include "polhode/exact/free_motion.hpp"

namespace polhode {

/// How a free gyrostat moves, decided at construction.
enum class GyrostatKind {
  rest,        ///< omega = 0
  steady,      ///< omega is constant and parallel to the momentum
  precession,  ///< omega runs on a circle at a constant rate: a sphere, or two equal moments with the rotor on the axis
  paired,  ///< the momentum has a second closed curve of the same energy on its sphere
  single,  ///< the momentum's curve is the only one of its energy
  separatrix,  ///< leaves an unstable steady rotation and returns to it, each in infinite time
};

/// "rest", "steady", "precession", "paired", "single" or "separatrix".
const char* to_text(GyrostatKind kind);

/// Torque-free motion of a rigid body with rotors, J omega' = (J omega + h) x omega with h constant in the body, in
/// closed form at any time. Rotors at a constant relative speed, or free on their bearings, give such an h.
///
/// The error against the exact motion from the same float64 input is a few units of rounding. That holds in every
/// regime and at every time up to |omega t| = 1e25 rad. With h = 0 the answers are those of FreeMotion.
/// Zhukovsky 1885; Volterra 1899, Acta Math. 22; Wittenburg 1977. See docs/gyrostat.md.
class Gyrostat {
 public:
  /// @param inertia J_B: of all with the rotors locked, or, for rotors free on their bearings, less their axial parts
  /// @param momentum h_B of the rotors in body axes [kg m^2/s]
  /// @param omega w_B at t = 0 [rad/s]
  /// @param attitude q_WB at t = 0
  /// @throws InvalidInput when a value is not finite, or the body has no moment about some axis
  Gyrostat(const InertiaTensor& inertia, const Vector3d& momentum, const Vector3d& omega, const Quat& attitude = {});

  /// The same from principal moments in the body axes, in any order.
  Gyrostat(const Vector3d& moments, const Vector3d& momentum, const Vector3d& omega, const Quat& attitude = {});

  State at(double t) const;

  /// n states: omega 3 n and attitude 4 n numbers, row by row; either pointer may be null.
  void at(const double* t, std::size_t n, double* omega, double* attitude) const;
  /// The same at times that were analysed before.
  void at(const exact::TimeGrid& times, double* omega, double* attitude) const;

  GyrostatKind kind() const { return kind_; }
  double period() const;              ///< of omega [s]; infinite on the separatrix, 0 where omega is constant
  double energy() const;              ///< T = omega . J omega / 2 [J]; constant, without what the rotors have beside it
  Vector3d angular_momentum() const;  ///< R (J omega + h) in space axes [kg m^2/s], constant

  /// (phi, theta, psi), intrinsic z-x-z, of the body axes in a space frame whose z axis is the total momentum (space z
  /// rotated to it the shortest way): precession, nutation, spin. Throws InvalidInput where that momentum is 0.
  Vector3d euler_angles(double t) const;

  /// J omega + h in body axes: it stays on the sphere |M| = L and on the ellipsoid of constant energy around h.
  Vector3d polhode(double t) const;

  const InertiaTensor& inertia() const { return inertia_; }
  const Vector3d& momentum() const { return momentum_; }    ///< h_B
  const Vector3d& omega() const { return omega_; }          ///< w_B(0)
  const Quat& attitude() const { return attitude_; }        ///< q_WB(0)

  friend bool operator==(const Gyrostat& a, const Gyrostat& b) {
    return a.inertia_ == b.inertia_ && a.momentum_ == b.momentum_ && a.omega_ == b.omega_ &&
           a.attitude_ == b.attitude_;
  }

 private:
  void set_up();
  void check_time(double t) const;
  Vector3d momentum_of(const Vector3d& omega) const;  ///< J omega

  InertiaTensor inertia_;
  Vector3d momentum_, omega_;
  Quat attitude_;
  std::optional<FreeMotion> free_;  ///< where h = 0
  GyrostatKind kind_ = GyrostatKind::rest;
  double period_ = 0.0, longest_ = 0.0;  ///< longest_: |t| of 1e25 rad
  exact::GyrostatSeries series_;
  exact::FreeFrame frame_{};
};

}  // namespace polhode
