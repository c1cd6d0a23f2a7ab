#pragma once

#include "method/steps/principal_body.hpp"

namespace polhode {

/// The rotation vector, in body axes, for the rates w(s) = c0 + c1 s + c2 s^2 + c3 s^3, 0 <= s <= s1, over a step of
/// length h. It is Magnus' expansion to order 6 on Gauss's points: Blanes, Casas & Ros 2000, BIT 40, 434, (3.7) to
/// (3.9). Rates in body axes multiply from the right, so each commutator changes its sign.
/// @param beyond  if not null, the difference from order 4, an estimate of the error
inline void compute_rotation_vector(const double* c, double h, double s1, double* rotation, double* beyond = nullptr) {
  // The points lie at m and m -+ d, d^2 = 3/20 s1^2. Differences of a cubic give its derivatives at m.
  constexpr double root15 = 3.8729833462074168852;
  const double m = 0.5 * s1, d = s1 * (root15 / 10), dd = d * d, width = h * s1;
  double a1[3], a2[3], a3[3], c1[3], c2[3], left[3], right[3];
  for (int i = 0; i < 3; ++i) {
    const double slope = c[3 + i] + m * (2 * c[6 + i] + m * (3 * c[9 + i]));
    a1[i] = width * (c[i] + m * (c[3 + i] + m * (c[6 + i] + m * c[9 + i])));
    a2[i] = width * (root15 * 2 / 3) * d * (slope + dd * c[9 + i]);
    a3[i] = width * (20.0 / 3) * dd * (c[6 + i] + 3 * m * c[9 + i]);
  }
  cross(a2, a1, c1);
  for (int i = 0; i < 3; ++i) right[i] = 2 * a3[i] + c1[i];
  cross(right, a1, c2);
  for (int i = 0; i < 3; ++i) left[i] = -20 * a1[i] - a3[i] + c1[i], right[i] = a2[i] - c2[i] / 60;
  cross(right, left, c2);
  for (int i = 0; i < 3; ++i) rotation[i] = a1[i] + a3[i] / 12 + c2[i] / 240;
  if (beyond) {
    for (int i = 0; i < 3; ++i) beyond[i] = c2[i] / 240 + c1[i] / 12;   // order 4: a1 + a3/12 - (a2 x a1)/12
  }
}

}  // namespace polhode
