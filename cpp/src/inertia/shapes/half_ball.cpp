#include "inertia/shapes/record.hpp"

namespace polhode::shapes {

MassProperties half_ball(double mass, double radius) {
  const Real m = positive(mass, "mass"), r = positive(radius, "radius");
  const Real across = 83 * m * r * r / 320;
  return along_axes(mass, across, across, 2 * m * r * r / 5, 3 * r / 8);
}

Record describe_half_ball() {
  return with_volume(make_record<&half_ball>("half_ball",
                                             "Half of a solid ball. The centre of its flat face is at the origin. Its "
                                             "pole is at (0, 0, r), and its centre of mass at (0, 0, 3/8 r). "
                                             "About the centre of mass: Ix = Iy = 83/320 m r^2, Iz = 2/5 m r^2.",
                                             {{"mass", "mass [kg]"}, {"radius", "r [m]"}}),
                     [](const double* v) -> Real { return 2 * pi / 3 * v[0] * v[0] * v[0]; });
}

}  // namespace polhode::shapes
