#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "polhode/core/quat.hpp"
#include "polhode/formula/ephemeris.hpp"

namespace polhode {

enum class OrbitKind { circular, elliptic, parabolic, hyperbolic, radial, table };

std::string_view to_text(OrbitKind kind);

/// Position and velocity in space axes [m, m/s].
struct OrbitState {
  Vector3d r, v;
};

/// From entering a shadow until leaving it; infinite where the path is dark from its beginning, or to its end [s].
struct Eclipse {
  double begin, end;
};

/// A conic by its elements. One of `periapsis_distance` and `semi_major_axis` is given.
struct OrbitElements {
  double mu;                                                                      ///< gravitational parameter [m^3/s^2]
  double periapsis_distance = std::numeric_limits<double>::quiet_NaN();           ///< [m]
  double semi_major_axis = std::numeric_limits<double>::quiet_NaN();              ///< of an ellipse [m]
  double e = 0.0;
  double inclination = 0.0, node = 0.0, periapsis = 0.0;   ///< rotations about z, x, z [rad]
  double anomaly = 0.0;                                    ///< the true anomaly at t0 [rad]
  double t0 = 0.0;                                         ///< [s]
  double j2 = 0.0;                                         ///< of an ellipse: the planet's flattening term
  double radius = 0.0;                                     ///< the planet's equatorial radius, with j2 [m]
};

/// A state at a time.
struct OrbitStart {
  double mu;
  Vector3d r0, v0;
  double t0;
};

/// Times, positions and velocities.
struct OrbitRows {
  std::vector<double> t;
  std::vector<Vector3d> r, v;
  double mu;   ///< NaN: not known
};

/// What an orbit was made of.
using OrbitGiven = std::variant<OrbitStart, OrbitElements, OrbitRows>;

/// The path of a body's centre of mass in space axes: a Kepler orbit on any conic, or a table.
///
/// A conic is computed in closed form at any time, by universal variables from the periapsis: r is accurate to some units
/// of rounding of the larger of |r| and what the rounding of t moves it. Whole periods are taken off in double-double.
/// Battin 1999, "An Introduction to the Mathematics and Methods of Astrodynamics", section 4.5.
class Orbit {
 public:
  /// The conic through a position and a velocity at t0.
  /// @throws InvalidInput for mu <= 0, r0 = 0, and numbers that are not finite
  static Orbit from_state(double mu, const Vector3d& r0, const Vector3d& v0, double t0 = 0.0);

  /// @throws InvalidInput for e < 0, an anomaly beyond the asymptotes, `semi_major_axis` with e >= 1, j2 without radius or
  ///         with e >= 1
  static Orbit from_elements(const OrbitElements& elements);

  /// Cubic Hermite pieces through positions and velocities; t increases. No extrapolation.
  /// @param mu  for torques that need it; NaN: not known
  static Orbit table(std::vector<double> t, std::vector<Vector3d> r, std::vector<Vector3d> v,
                     double mu = std::numeric_limits<double>::quiet_NaN());

  /// @throws InvalidInput for a time that is not finite, outside a table, or beyond one at which a radial orbit has |r| = 0
  OrbitState at(double t) const;

  /// When the path is in the shadow of the central body, a cylinder: r.s < 0 and |r|^2 - (r.s)^2 < radius^2, with s the
  /// direction of the sun. Each shadow that meets the span, with its own edges, which are rounded once.
  /// @param sun     towards it, space axes, of any length
  /// @param radius  of the shadow [m]
  /// @throws InvalidInput for an orbit that goes nearer than the radius, a sun 0, and times outside a table
  std::vector<Eclipse> find_eclipses(const Vector3d& sun, double radius, double first, double last) const;

  OrbitKind kind() const;
  double mu() const;                   ///< NaN: a table without it
  double e() const;                    ///< NaN of a table
  double period() const;               ///< infinite unless elliptic; NaN of a table [s]
  double periapsis_distance() const;   ///< NaN of a table [m]
  double t0() const;                   ///< of the given state; the first time of a table [s]
  double first_time() const;           ///< of a table; else minus infinity
  double last_time() const;

  const OrbitGiven& given() const;
  /// The orbit for torques and formulas, which see it as a known function of time.
  /// @param name  in the texts of formulas
  /// @throws InvalidInput for a table, which has no Taylor series over its times
  formula::Ephemeris ephemeris(std::string name = {}) const;
  /// The orbit that an ephemeris is of.
  static std::optional<Orbit> from_ephemeris(const formula::Ephemeris& ephemeris);

  /// Made of the same numbers.
  friend bool operator==(const Orbit& a, const Orbit& b);

  class Path;

 private:
  explicit Orbit(std::shared_ptr<const Path> path);
  std::shared_ptr<const Path> path_;
};

}  // namespace polhode
