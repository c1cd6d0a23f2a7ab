#pragma once

#include <string>
#include <vector>

#include "polhode/scene/scene.hpp"

// How large a torque can be: what a bound on its effect starts from.
namespace polhode::effect {

/// |tau(t)| <= fixed + |matrix w0(t)| + per_rate |w - w0| for every attitude, where w0 is the motion without the torque.
struct TorqueSize {
  double fixed = 0.0;                     ///< [N m]
  Matrix3d matrix = Matrix3d::Zero();     ///< of a torque linear in the rates, body axes [N m s]
  double per_rate = 0.0;                  ///< [N m s]
  std::vector<torques::Window> windows = {};   ///< outside them the torque is zero; empty: it acts always
  std::string refusal = {};               ///< why no size is known

  bool is_zero() const { return fixed == 0.0 && per_rate == 0.0 && matrix.isZero(0.0); }
};

/// The same in other units: of moments 2^moment_exponent, of rates 2^rate_exponent.
TorqueSize scale(TorqueSize size, int moment_exponent, int rate_exponent);

/// The region in which the torque is bounded: every attitude, the span, and rates near those of the free body.
struct Region {
  Matrix3d inertia_B;
  double gap;                ///< the greatest moment less the least [kg m^2]
  double begin, end;         ///< [s]
  Vector3d most_rates_B;     ///< bounds on |omega_i| of the free body, body axes [rad/s]
  double margin;             ///< by which the rates may differ from these [rad/s]
};

TorqueSize find_size(const AnyTorque& torque, const Region& region);

/// The same of a formula, by intervals over all unit quaternions. Infinite where no bound is found.
double bound_formula(const torques::Formula& formula, const Region& region);

/// A lower estimate of the size from the start alone, in a few instructions; 0 for a torque of which nothing is known
/// without its bound.
double glance_at_size(const AnyTorque& torque, const Scene& scene);

}  // namespace polhode::effect
