#include "inertia/shapes/record.hpp"

namespace polhode::shapes {

MassProperties cone(double mass, double radius, double height) {
  const Real m = positive(mass, "mass"), r = positive(radius, "radius"), h = positive(height, "height");
  const Real across = 3 * m * (4 * r * r + h * h) / 80;
  return along_axes(mass, across, across, 3 * m * r * r / 10, h / 4);
}

Record describe_cone() {
  return with_volume(
      make_record<&cone>("cone",
                            "A solid cone round z. The centre of its base is at the origin, its apex at (0, 0, h), and "
                            "its centre of mass at (0, 0, h/4). "
                            "About the centre of mass: Ix = Iy = 3/80 m (4 r^2 + h^2), Iz = 3/10 m r^2.",
                            {{"mass", "mass [kg]"}, {"radius", "r of the base [m]"}, {"height", "h [m]"}}),
      [](const double* v) -> Real { return pi / 3 * v[0] * v[0] * v[1]; });
}

}  // namespace polhode::shapes
