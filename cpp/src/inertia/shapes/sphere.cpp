#include "inertia/shapes/record.hpp"

namespace polhode::shapes {

MassProperties sphere(double mass, double radius) {
  const Real m = positive(mass, "mass"), r = positive(radius, "radius");
  const Real I = 2 * m * r * r / 5;
  return along_axes(mass, I, I, I);
}

Record describe_sphere() {
  return with_volume(
      make_record<&sphere>("sphere", "A solid ball. I = 2/5 m r^2.", {{"mass", "mass [kg]"}, {"radius", "r [m]"}}),
      [](const double* v) -> Real { return 4 * pi / 3 * v[0] * v[0] * v[0]; });
}

}  // namespace polhode::shapes
