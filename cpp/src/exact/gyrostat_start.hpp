#pragma once

#include "polhode/exact/gyrostat.hpp"
#include "polhode/math/detail/double_double.hpp"

namespace polhode::exact {

/// The start in working axes, scaled by powers of two so that the largest moment and the largest of |omega|,
/// |h| / moment are near 1. Two equal moments have at most one component of h across their axis, or none of it.
struct GyrostatStart {
  double J[3];
  math::DD h[3], w[3];
};

/// Properties of the motion besides its series, in the scaled units.
struct GyrostatMotion {
  GyrostatKind kind = GyrostatKind::steady;
  double period = 0.0;  ///< of omega; inf on the separatrix, 0 where omega is constant
};

}  // namespace polhode::exact
