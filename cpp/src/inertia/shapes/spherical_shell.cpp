#include "inertia/shapes/record.hpp"

namespace polhode::shapes {

MassProperties spherical_shell(double mass, double radius) {
  const Real m = positive(mass, "mass"), r = positive(radius, "radius");
  const Real I = 2 * m * r * r / 3;
  return along_axes(mass, I, I, I);
}

Record describe_spherical_shell() {
  return make_record<&spherical_shell>("spherical_shell", "A thin shell in the form of a sphere. I = 2/3 m r^2.",
                                       {{"mass", "mass [kg]"}, {"radius", "r [m]"}});
}

}  // namespace polhode::shapes
