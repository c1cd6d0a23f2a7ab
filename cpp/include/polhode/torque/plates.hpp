#pragma once

#include <vector>

#include "polhode/core/quat.hpp"
#include "polhode/formula/ephemeris.hpp"
#include "polhode/torque/formula.hpp"

namespace polhode {

/// A flat plate on a body. One side faces outwards; a thin panel is two plates. Plates do not shade each other.
struct Plate {
  double area;                          ///< [m^2]
  Vector3d normal;                      ///< outward, body axes, of any length
  Vector3d centre;                      ///< from the centre of mass [m]
  double specular = 0.0, diffuse = 0.0;   ///< shares of the light that are reflected so
};

/// An atmosphere that turns with its planet: density exp((height_radius - |r|) / scale_height).
struct Atmosphere {
  double density;         ///< at |r| = height_radius [kg/m^3]
  double height_radius;   ///< [m]
  double scale_height;    ///< [m]
  double spin = 0.0;      ///< about space z [rad/s]
};

namespace torques {

/// Drag on plates, free molecular and without lift: b = R^T (v - spin e_z x r),
/// tau_B = sum over the plates of c x (-Cd/2 A rho (n.b)_+ b). The rates of the body are neglected beside b.
/// Parameters of the formula: `coefficient`, `density` and `scale_height`.
/// @throws InvalidInput for no plates, area < 0, a normal 0, and an atmosphere without positive numbers
Formula make_drag(const std::vector<Plate>& plates, const formula::Ephemeris& orbit, double coefficient,
                  const Atmosphere& atmosphere);

/// The pressure of light on plates, s = R^T sun, c = (n.s)_+: forces -p A c ((1 - specular) s + 2 (specular c +
/// diffuse/3) n). Wertz 1978, Spacecraft Attitude Determination and Control, sec. 17.2. The parameter is `pressure`.
/// @param sun       towards the sun, space axes, of any length
/// @param pressure  at the body [N/m^2]
/// @throws InvalidInput also for specular + diffuse > 1, and a sun 0
Formula make_solar_pressure(const std::vector<Plate>& plates, const Vector3d& sun, double pressure);

}  // namespace torques
}  // namespace polhode
