#pragma once

#include <cstddef>

#include "polhode/exact/free_motion.hpp"

namespace polhode {

/// A free body with damping proportional to its angular momentum, tau_B = -c I w_B, in closed form at any time.
///
/// It is the free motion in slowed time: q(t) = q_free(s), w(t) = e^-ct w_free(s), s = (1 - e^-ct) / c. The error is
/// that of FreeMotion. See docs/damped_free.md. Immutable.
class DampedFree {
 public:
  /// @param inertia   I_B, any body that FreeMotion takes [kg m^2]
  /// @param damping   c [1/s]; a negative rate drives the body
  /// @param omega     w_B at t = 0 [rad/s]
  /// @param attitude  q_WB at t = 0
  /// @throws InvalidInput as FreeMotion does, and for a rate that is not finite
  DampedFree(const InertiaTensor& inertia, double damping, const Vector3d& omega, const Quat& attitude = {});
  /// The same from principal moments in the body axes, in any order.
  DampedFree(const Vector3d& moments, double damping, const Vector3d& omega, const Quat& attitude = {});

  /// @throws InvalidInput for a time that is not finite, or at which omega or the angle of rotation is beyond float64
  State at(double t) const;
  /// n states: omega 3 n and attitude 4 n numbers, row by row; either pointer may be null.
  void at(const double* t, std::size_t n, double* omega, double* attitude) const;

  double slowed_time(double t) const;   ///< s = (1 - e^-ct) / c [s]
  double total_angle() const;           ///< a bound on the angle of rotation from t = 0 on [rad]; infinite for c <= 0

  double damping() const { return damping_; }              ///< c [1/s]
  const FreeMotion& free() const { return free_; }         ///< the motion in slowed time
  const InertiaTensor& inertia() const { return free_.inertia(); }
  const Vector3d& omega() const { return free_.omega(); }       ///< w_B(0)
  const Quat& attitude() const { return free_.attitude(); }     ///< q_WB(0)

  friend bool operator==(const DampedFree& a, const DampedFree& b) {
    return a.free_ == b.free_ && a.damping_ == b.damping_;
  }

 private:
  void check_time(double t) const;
  void write_part(const double* t, std::size_t n, double* omega, double* attitude) const;

  FreeMotion free_;
  double damping_;
};

}  // namespace polhode
