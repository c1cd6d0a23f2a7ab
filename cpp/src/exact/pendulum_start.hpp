#pragma once

#include <string>

#include "polhode/exact/pendulum.hpp"
#include "polhode/math/detail/double_double.hpp"

// The constants of a plane pendulum from its start, in double-double.
namespace polhode::exact {

/// The body axis of rotation, or -1 and the reason.
struct PendulumAxis {
  int axis = -1;
  std::string why_not;
};

/// The body axis e about which the body swings: I e is along e, e . r = 0, e is horizontal, omega is along e. All tests
/// are exact, and homogeneous in the quaternion, whose length therefore does not matter.
PendulumAxis find_pendulum_axis(const Matrix3d& inertia_B, const Vector3d& arm, const Vector3d& omega,
                                const Quat& attitude);

/// Whether float64 can hold the ratio of omega to the frequency of small swings.
bool carries_pendulum(double moment, double weight, const Vector3d& arm, double omega);

/// theta is the angle of the arm from the hanging position, about the axis with omega along it. Rates are in units of
/// 2^rate_exponent rad/s. The argument is u = rate t + u0, and (sn, cn, dn) are those of u0.
struct PendulumStart {
  PendulumKind kind = PendulumKind::rest;
  int rate_exponent = 0;
  math::DD half_sine, half_cosine;      ///< of theta / 2 at the start
  math::DD frequency;                   ///< of small swings
  math::DD rate, k, kc, sn, cn, dn;
};

PendulumStart analyse_pendulum(double moment, double weight, const Vector3d& arm, double omega, const Quat& attitude,
                               int axis);

}  // namespace polhode::exact
