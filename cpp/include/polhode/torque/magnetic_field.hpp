#pragma once

#include <vector>

#include "polhode/core/quat.hpp"
#include "polhode/formula/expression.hpp"
#include "polhode/torque/formula.hpp"

namespace polhode {

/// The magnetic field of a planet that turns about space z, as a body on an orbit meets it [T, space axes].
///
/// A tilted dipole, or Gauss coefficients: V = a sum (a/r)^(n+1) (g cos m l + h sin m l) P_n^m(sin latitude),
/// B = -grad V, Schmidt semi-normalised without the Condon-Shortley phase, l = longitude - (spin t + phase).
class MagneticField {
 public:
  static constexpr int most_degree = 13;
  using Coefficients = std::vector<std::vector<double>>;   ///< [n][m] for m = 0 to n

  /// B = strength / r^3 (3 (m.u) u - m), u = r / |r|, m = (sin tilt cos a, sin tilt sin a, cos tilt), a = spin t + phase.
  /// @param strength  [T m^3]; about the Earth 7.9e15, with a tilt near pi - 0.17: m points to the south
  /// @throws InvalidInput for a number that is not finite
  static MagneticField dipole(formula::Ephemeris orbit, double strength, double tilt = 0.0, double spin = 0.0,
                              double phase = 0.0);
  /// @param radius  a, of the coefficients [m]
  /// @param g, h    [T]; row n has n + 1 numbers, and row 0 is 0
  /// @throws InvalidInput for a radius that is not positive, other shapes, h[n][0] != 0 and a degree above 13
  static MagneticField gauss(formula::Ephemeris orbit, double radius, const Coefficients& g, const Coefficients& h,
                             double spin = 0.0, double phase = 0.0);

  Vector3d at(double t) const;                       ///< on the orbit
  Vector3d at(double t, const Vector3d& r) const;    ///< anywhere but at the centre
  /// The same while a formula is traced.
  formula::Vec<formula::Expr, 3> see(const formula::Expr& t) const;

  const formula::Ephemeris& orbit() const { return orbit_; }

 private:
  struct Term {
    int n, m;
    double g, h;   ///< times the norm of P_n^m
  };

  MagneticField(formula::Ephemeris orbit, double spin, double phase);

  template <class T>
  formula::Vec<T, 3> compute(const T& t, const formula::Vec<T, 3>& r, const T& inverse_distance) const;
  template <class T>
  formula::Vec<T, 3> compute_dipole(const T& sine, const T& cosine, const formula::Vec<T, 3>& r, const T& u) const;
  template <class T>
  formula::Vec<T, 3> compute_harmonics(const formula::Vec<T, 3>& r, const T& u) const;

  formula::Ephemeris orbit_;
  double spin_, phase_;
  double strength_ = 0.0, sine_tilt_ = 0.0, cosine_tilt_ = 0.0;
  double radius_ = 0.0;
  std::vector<Term> terms_;   ///< by n, then m; none: a dipole
};

namespace torques {

/// The torque m x R^T B of a magnetic moment fixed in the body [A m^2]: a formula with the parameter `moment`.
/// Wertz 1978, Spacecraft Attitude Determination and Control, sec. 17.2.
Formula make_dipole(const Vector3d& moment, const MagneticField& field);

}  // namespace torques
}  // namespace polhode
