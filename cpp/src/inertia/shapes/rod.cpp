#include "inertia/shapes/record.hpp"

namespace polhode::shapes {

MassProperties rod(double mass, double length) {
  const Real m = positive(mass, "mass"), l = positive(length, "length");
  const Real across = m * l * l / 12;
  return along_axes(mass, across, across, 0);
}

Record describe_rod() {
  return make_record<&rod>(
      "rod",
      "A thin rod along z. "
      "Ix = Iy = m l^2 / 12, Iz = 0: a valid tensor, though no rotation about z can be computed from it.",
      {{"mass", "mass [kg]"}, {"length", "l, the full length [m]"}});
}

}  // namespace polhode::shapes
