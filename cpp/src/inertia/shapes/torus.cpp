#include "inertia/shapes/record.hpp"

namespace polhode::shapes {

MassProperties torus(double mass, double major_radius, double minor_radius) {
  const Real m = positive(mass, "mass"), R = positive(major_radius, "major_radius");
  const Real r = not_negative(minor_radius, "minor_radius");
  if (r > R) {
    throw InvalidInput("minor_radius", "at most major_radius (" + to_text(major_radius) + ")", to_text(minor_radius),
                       "the two radii exchanged? The tube would run through itself");
  }
  const Real across = m * (4 * R * R + 5 * r * r) / 8;
  return along_axes(mass, across, across, m * (4 * R * R + 3 * r * r) / 4);
}

Record describe_torus() {
  return with_volume(
      make_record<&torus>("torus",
                             "A solid ring round z: a tube of radius r whose centre line is a circle of radius R >= r. "
                             "Ix = Iy = m (R^2 / 2 + 5/8 r^2), Iz = m (R^2 + 3/4 r^2).",
                             {{"mass", "mass [kg]"},
                              {"major_radius", "R, of the centre line [m]"},
                              {"minor_radius", "r, of the tube [m]; 0 is a thin ring"}}),
      [](const double* v) -> Real { return 2 * pi * pi * v[0] * v[1] * v[1]; });
}

}  // namespace polhode::shapes
