#pragma once

#include "polhode/core/quat.hpp"

// The Taylor series of a Kepler orbit: r'' = -mu r / |r|^3 in its plane, which may rotate.
namespace polhode::kepler {

/// A state in the plane of a conic [m, m/s].
struct PlaneState {
  double x, y, vx, vy;
};

/// The axes x and y of the plane in space at a time, and the rates at which the plane rotates about space z and about its
/// own normal [rad/s].
struct MovingPlane {
  Vector3d x, y;
  double node_rate, periapsis_rate;
};

/// Rows 0 to `order` of the coefficients of r, v, |r| and 1/|r| in powers of time / unit, eight numbers a row.
/// In units of |r| at the start: s = r.r, u = s^(-3/2) by s u' = -3/2 u s', 1/|r| = s u, |r| = s (1/|r|), r'' = -mu r u.
void expand(double mu, const PlaneState& start, const MovingPlane& plane, double unit, int order, double* rows);

}  // namespace polhode::kepler
