#include "inertia/shapes/record.hpp"

namespace polhode::shapes {

MassProperties cylindrical_shell(double mass, double radius, double height) {
  const Real m = positive(mass, "mass"), r = positive(radius, "radius"), h = positive(height, "height");
  const Real across = m * (6 * r * r + h * h) / 12;
  return along_axes(mass, across, across, m * r * r);
}

Record describe_cylindrical_shell() {
  return make_record<&cylindrical_shell>(
      "cylindrical_shell",
      "A thin tube round z, open at both ends. "
      "Ix = Iy = m (6 r^2 + h^2) / 12, Iz = m r^2.",
      {{"mass", "mass [kg]"}, {"radius", "r [m]"}, {"height", "h, the full height [m]"}});
}

}  // namespace polhode::shapes
