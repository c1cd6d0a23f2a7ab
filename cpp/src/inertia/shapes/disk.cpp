#include "inertia/shapes/record.hpp"

namespace polhode::shapes {

MassProperties disk(double mass, double radius) {
  const Real m = positive(mass, "mass"), r = positive(radius, "radius");
  return along_axes(mass, m * r * r / 4, m * r * r / 4, m * r * r / 2);
}

Record describe_disk() {
  return make_record<&disk>("disk",
                            "A thin disk in the plane z = 0. "
                            "Ix = Iy = m r^2 / 4, Iz = m r^2 / 2.",
                            {{"mass", "mass [kg]"}, {"radius", "r [m]"}});
}

}  // namespace polhode::shapes
