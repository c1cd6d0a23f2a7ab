#include "inertia/shapes/record.hpp"

namespace polhode::shapes {

MassProperties capsule_shell(double mass, double radius, double cylinder_height) {
  const Real m = positive(mass, "mass"), r = positive(radius, "radius", "rod");
  const Real h = not_negative(cylinder_height, "cylinder_height");
  const Real tube = m * (h / (h + 2 * r)), caps = m * (2 * r / (h + 2 * r));  // their masses
  const Real across = tube * (6 * r * r + h * h) / 12 + caps * (2 * r * r / 3 + h * h / 4 + h * r / 2);
  return along_axes(mass, across, across, tube * r * r + caps * 2 * r * r / 3);
}

Record describe_capsule_shell() {
  return make_record<&capsule_shell>(
      "capsule_shell",
      "A thin shell in the form of a capsule round z: a tube between two half spheres, of one density per area. With "
      "the masses mc of the tube and ms of the half spheres, in the ratio h : 2 r, "
      "Ix = Iy = mc (6 r^2 + h^2) / 12 + ms (2/3 r^2 + h^2 / 4 + h r / 2), Iz = mc r^2 + 2/3 ms r^2.",
      {{"mass", "mass [kg]"},
       {"radius", "r of tube and caps [m]"},
       {"cylinder_height", "h between the caps [m]; 0 is a sphere"}});
}

}  // namespace polhode::shapes
