#include "inertia/shapes/record.hpp"

namespace polhode::shapes {

MassProperties hollow_box(double mass, const Vector3d& half_sides, double wall) {
  const Real m = positive(mass, "mass"), w = not_negative(wall, "wall");
  positive(half_sides, "half_sides");
  if (w > half_sides.minCoeff()) {
    throw InvalidInput("wall", "at most the smallest of half_sides (" + to_text(half_sides.minCoeff()) + ")",
                       to_text(wall), "the walls would meet");
  }
  // With the cavity's half sides a' = a - w, the volume is 8 w V and the integral of x^2 is 8/3 w S_x, both written as
  // sums of positive terms, so that a thin wall costs no digits and w = 0 is its limit.
  Real S[3], V = 0;
  for (int i = 0; i < 3; ++i) {
    const Real a = half_sides[i], b = half_sides[(i + 1) % 3], c = half_sides[(i + 2) % 3];
    const Real a_in = a - w, b_in = b - w;
    const Real faces = c + b_in;  // (b c - b' c') / w
    V = b * c + a_in * faces;
    S[i] = (a * a + a * a_in + a_in * a_in) * b * c + a_in * a_in * a_in * faces;
  }
  const Real f = m / (3 * V);
  return along_axes(mass, f * (S[1] + S[2]), f * (S[2] + S[0]), f * (S[0] + S[1]));
}

Record describe_hollow_box() {
  return with_volume(make_record<&hollow_box>(
      "hollow_box",
      "A closed box with sides 2a, 2b, 2c along x, y, z outside and walls of one thickness w all round. "
      "With V = a b c - a' b' c', where a' = a - w and so on: Ix = m (a (b^3 c + b c^3) - a' (b'^3 c' + b' c'^3)) / (3 "
      "V), and cyclically.",
      {{"mass", "mass [kg]"},
       {"half_sides", "a, b, c: half of each outer side [m]"},
       {"wall", "w, thickness of the walls [m]; 0 is the limit of a thin sheet"}}),
                     [](const double* v) {
                       const Real a = v[0], b = v[1], c = v[2], w = v[3];
                       return 8 * w * (b * c + (a - w) * (c + b - w));
                     });
}

}  // namespace polhode::shapes
