#pragma once

#include "solve/methods/principal_body.hpp"

namespace polhode {

/// The rotation vector, in body axes, of the turn that the rates w(s) = c0 + c1 s + c2 s^2 + c3 s^3, 0 <= s <= s1, make in
/// a step of length h: Magnus' expansion to order 6 on Gauss's points. Blanes, Casas & Ros 2000, BIT 40, 434, (3.7) to
/// (3.9); rates in body axes multiply from the right, so each commutator changes its sign. `beyond`, where it is not
/// null: what it adds to order 4, which tells how far to trust it.
inline void compute_turn(const double* c, double h, double s1, double* turn, double* beyond = nullptr) {
  constexpr double root15 = 3.8729833462074168852;
  const double points[3] = {s1 * (0.5 - root15 / 10), s1 * 0.5, s1 * (0.5 + root15 / 10)}, width = h * s1;
  double A[3][3], a1[3], a2[3], a3[3], c1[3], c2[3], left[3], right[3];
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) {
      A[k][i] = c[i] + points[k] * (c[3 + i] + points[k] * (c[6 + i] + points[k] * c[9 + i]));
    }
  }
  for (int i = 0; i < 3; ++i) {
    a1[i] = width * A[1][i];
    a2[i] = width * (root15 / 3) * (A[2][i] - A[0][i]);
    a3[i] = width * (10.0 / 3) * (A[2][i] - 2 * A[1][i] + A[0][i]);
  }
  cross(a2, a1, c1);
  for (int i = 0; i < 3; ++i) right[i] = 2 * a3[i] + c1[i];
  cross(right, a1, c2);
  for (int i = 0; i < 3; ++i) left[i] = -20 * a1[i] - a3[i] + c1[i], right[i] = a2[i] - c2[i] / 60;
  cross(right, left, c2);
  for (int i = 0; i < 3; ++i) turn[i] = a1[i] + a3[i] / 12 + c2[i] / 240;
  if (beyond) {
    for (int i = 0; i < 3; ++i) beyond[i] = c2[i] / 240 + c1[i] / 12;   // order 4: a1 + a3/12 - (a2 x a1)/12
  }
}

}  // namespace polhode
