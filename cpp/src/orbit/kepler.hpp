#pragma once

#include "polhode/math/detail/double_double.hpp"

// Kepler's equation from the periapsis in universal variables, on every conic: Battin 1999, section 4.5, with r0 = q and
// no radial velocity there. chi is the eccentric anomaly over sqrt(alpha), and alpha = (1 - e) / q.
//   sqrt(mu) t = q chi + e chi^3 c3,  |r| = q + e chi^2 c2,
//   x = q - chi^2 c2,  y = sqrt(q (1 + e)) chi c1,  c_k(psi) = sum (-psi)^j / (2j + k)!,  psi = alpha chi^2.
namespace polhode::kepler {

/// A conic in its own plane: alpha = 1/a [1/m], the periapsis distance q [m] and e = 1 - q alpha.
struct Conic {
  math::DD alpha, q, e;
};

/// chi^k c_k for k = 0 to 3.
template <class T>
struct Anomaly {
  T u0, u1, u2, u3;
};

Anomaly<double> compute_anomaly(double alpha, double chi);
Anomaly<math::DD> compute_anomaly(math::DD alpha, math::DD chi);

/// The anomaly where sqrt(mu) t = n, to rounding. |n| is at most that of half a period.
Anomaly<double> solve(const Conic& conic, double n);

/// chi of a state with radius r and sigma = r.v / sqrt(mu).
math::DD find_chi(const Conic& conic, math::DD r, math::DD sigma);

/// chi of a true anomaly nu; NaN beyond the asymptotes of a hyperbola.
math::DD find_chi(const Conic& conic, double nu);

/// sqrt(mu) t since the periapsis.
math::DD compute_time(const Conic& conic, math::DD chi);

}  // namespace polhode::kepler
