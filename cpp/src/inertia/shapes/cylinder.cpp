#include "inertia/shapes/record.hpp"

namespace polhode::shapes {

MassProperties cylinder(double mass, double radius, double height) {
  const Real m = positive(mass, "mass"), r = positive(radius, "radius", "rod"), h = positive(height, "height", "disk");
  const Real across = m * (3 * r * r + h * h) / 12;
  return along_axes(mass, across, across, m * r * r / 2);
}

Record describe_cylinder() {
  return with_volume(
      make_record<&cylinder>("cylinder",
                                "A solid cylinder round z. "
                                "Ix = Iy = m (3 r^2 + h^2) / 12, Iz = m r^2 / 2.",
                                {{"mass", "mass [kg]"}, {"radius", "r [m]"}, {"height", "h, the full height [m]"}}),
      [](const double* v) -> Real { return pi * v[0] * v[0] * v[1]; });
}

}  // namespace polhode::shapes
