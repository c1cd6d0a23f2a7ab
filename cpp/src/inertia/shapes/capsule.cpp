#include "inertia/shapes/record.hpp"

namespace polhode::shapes {

MassProperties capsule(double mass, double radius, double cylinder_height) {
  const Real m = positive(mass, "mass"), r = positive(radius, "radius", "rod");
  const Real h = not_negative(cylinder_height, "cylinder_height");
  const Real cylinder = m * (3 * h / (3 * h + 4 * r)), caps = m * (4 * r / (3 * h + 4 * r));  // their masses
  const Real across = cylinder * (3 * r * r + h * h) / 12 + caps * (2 * r * r / 5 + h * h / 4 + 3 * h * r / 8);
  return along_axes(mass, across, across, cylinder * r * r / 2 + caps * 2 * r * r / 5);
}

Record describe_capsule() {
  return with_volume(
      make_record<&capsule>(
      "capsule",
      "A solid cylinder round z between two half balls. With the masses mc of the cylinder and ms of the caps, in the "
      "ratio 3 h : 4 r, "
      "Ix = Iy = mc (3 r^2 + h^2) / 12 + ms (2/5 r^2 + h^2 / 4 + 3/8 h r), Iz = mc r^2 / 2 + 2/5 ms r^2.",
      {{"mass", "mass [kg]"},
       {"radius", "r of cylinder and caps [m]"},
       {"cylinder_height", "h between the caps [m]; 0 is a ball"}}),
      [](const double* v) -> Real { return pi * v[0] * v[0] * (v[1] + 4 * Real(v[0]) / 3); });
}

}  // namespace polhode::shapes
