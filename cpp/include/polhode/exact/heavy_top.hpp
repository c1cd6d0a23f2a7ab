#pragma once

#include <cstddef>

#include "polhode/core/state.hpp"
#include "polhode/exact/detail/heavy_top_kernel.hpp"
#include "polhode/exact/detail/time_grid.hpp"
#include "polhode/inertia/inertia_tensor.hpp"

namespace polhode {

/// How a heavy symmetric top moves. `looping`, `cuspidal` and `monotone` describe the precession of its axis.
enum class TopKind {
  free,                ///< no weight
  sleeping,            ///< the axis is at rest, centre of mass above the pivot (stable or not)
  hanging,             ///< the axis is at rest, centre of mass below the pivot
  steady_precession,   ///< constant tilt, between the two
  planar_pendulum,     ///< no spin about the axis, no precession
  spherical_pendulum,  ///< no spin about the axis
  homoclinic,          ///< leaves the upright position and returns to it, each in infinite time
  looping,             ///< the precession changes sign
  cuspidal,            ///< the precession stops at the highest point
  monotone,            ///< the precession keeps its sign
};

const char* to_text(TopKind kind);  ///< the names above

/// Lagrange's top: a rigid body with two equal moments, held at a point of its symmetry axis, under gravity along -z
/// of space. In closed form: every time costs the same and is equally accurate.
/// Klein & Sommerfeld, Ueber die Theorie des Kreisels (1897-1910); docs/heavy_top.md.
/// A rotor on the symmetry axis is a second rotation about it: see docs/heavy_top.md.
/// The symmetry axis is body z for moments (A, A, C); else the axis of the third moment, with its largest component
/// positive. Immutable.
class HeavyTop {
 public:
  /// @param inertia I_B about the pivot [kg m^2], two moments equal within 32 ulp of the largest
  /// @param weight_arm mass x gravity x distance of the centre of mass from the pivot, signed along the axis [N m]
  /// @param omega w_B at t = 0 [rad/s]
  /// @param attitude q_WB at t = 0
  /// @param rotor momentum h of rotors about the symmetry axis, constant in the body [kg m^2/s]
  /// @throws InvalidInput when a value is not finite, the body not a symmetric top, or the motion beyond float64
  HeavyTop(const InertiaTensor& inertia, double weight_arm, const Vector3d& omega, const Quat& attitude = {},
           double rotor = 0.0);
  /// The same from moments along the body axes.
  HeavyTop(const Vector3d& moments, double weight_arm, const Vector3d& omega, const Quat& attitude = {},
           double rotor = 0.0);

  State at(double t) const;
  /// omega: n x 3, attitude: n x 4, row-major; either may be null.
  void at(const double* t, std::size_t n, double* omega, double* attitude) const;
  /// The same at times that were analysed before.
  void at(const exact::TimeGrid& times, double* omega, double* attitude) const;

  TopKind kind() const noexcept { return kind_; }
  /// Of the tilt [s] (a planar pendulum's is half its swing); inf for homoclinic, 0 where the tilt is constant.
  double nutation_period() const noexcept { return period_; }
  double tilt_min() const noexcept { return tilt_min_; }       ///< between body axis and space z [rad]
  double tilt_max() const noexcept { return tilt_max_; }
  /// Mean rate of the axis about space z, over a nutation [rad/s]; NaN if the axis stays vertical or reaches the
  /// vertical in infinite time.
  double precession_rate() const noexcept { return precession_; }
  double energy() const;  ///< kinetic without that inside rotors, and weight_arm cos(tilt) [J]
  double p_phi() const;   ///< angular momentum about space z, with rotors [kg m^2/s]
  double p_psi() const;   ///< angular momentum about the symmetry axis, with rotors [kg m^2/s]

  const InertiaTensor& inertia() const noexcept { return inertia_; }  ///< about the pivot
  const Vector3d& axis() const noexcept { return axis_; }        ///< the symmetry axis in body axes, unit
  double weight_arm() const noexcept { return weight_arm_; }
  double rotor() const noexcept { return rotor_; }
  const Vector3d& omega() const noexcept { return omega_; }
  const Quat& attitude() const noexcept { return attitude_; }
  const exact::HeavyTopConstants& constants() const noexcept { return constants_; }

  friend bool operator==(const HeavyTop& a, const HeavyTop& b) {
    return a.inertia_ == b.inertia_ && a.weight_arm_ == b.weight_arm_ && a.omega_ == b.omega_ &&
           a.attitude_ == b.attitude_ && a.rotor_ == b.rotor_;
  }

 private:
  void set_up();
  void rotate_back(const exact::TimeGrid& times, double* omega, double* attitude) const;

  InertiaTensor inertia_;
  double weight_arm_;
  Vector3d omega_;
  Quat attitude_;
  double rotor_;
  double half_turns_ = 0, half_turns_low_ = 0;  ///< h / C / 2 [cycles/s], of half the angle that rotors rotate back
  Vector3d axis_ = Vector3d::UnitZ();
  TopKind kind_ = TopKind::steady_precession;
  double period_ = 0, tilt_min_ = 0, tilt_max_ = 0, precession_ = 0, largest_time_ = 0;
  double scaled_[3] = {};  ///< energy, p_phi, p_psi in units of powers of two
  int scale_of_A_ = 0, scale_of_rate_ = 0;
  exact::HeavyTopConstants constants_;
};

}  // namespace polhode
