#pragma once

#include <vector>

#include "solve/effect/free_table.hpp"
#include "solve/effect/torque_size.hpp"

// The integrals over time of a torque's size and of what the free body makes of it.
namespace polhode::effect {

/// Bounds on int |..| b ds, the largest over the span, where b is the size of a torque.
struct Integrals {
  double rate = 0.0;       ///< of int |J^-1/2 S J^-1/2| b ds [rad/s]
  double state = 0.0;      ///< of int |S J^-1/2| b ds
  double rotation = 0.0;   ///< of int |Psi| b ds [rad]
  double whole = 0.0;      ///< int b ds over the span
  double repeated = 0.0;     ///< int k b ds, with the periods k that remain
  double first_rate = 0.0, first_rotation = 0.0;   ///< the first and the third by the midpoint rule: no bounds

  Integrals& operator+=(const Integrals& other);
  friend Integrals operator*(double factor, const Integrals& of);
};

/// Those of a torque, and what a difference of the rates from those of the free body adds, per rad/s.
struct Share {
  Integrals fixed, per_rate;
};
/// @param axes      the principal axes, R_BP
/// @param direction  1 for times after t0, -1 before: then the table is that of the reversed motion
Share integrate(const FreeTable& table, const TorqueSize& size, const Matrix3d& axes, double t0, int direction);

/// The same of a change of y at any time, of unit size: the largest of int |J^-1/2 S|, int |S| and int |Psi J^1/2| ds.
Integrals integrate_unit(const FreeTable& table);

}  // namespace polhode::effect
