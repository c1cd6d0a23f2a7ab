#include "inertia/shapes/record.hpp"

namespace polhode::shapes {

MassProperties frustum(double mass, double base_radius, double top_radius, double height) {
  const Real m = positive(mass, "mass"), R = positive(base_radius, "base_radius");
  const Real r = not_negative(top_radius, "top_radius"), h = positive(height, "height");
  const Real S = R * R + R * r + r * r;
  const Real axial = 3 * m * (R * R * R * R + R * r * S + r * r * r * r) / (10 * S);
  const Real slope = (R * R + r * r) / S, mixed = R * r / S;  // slope + mixed = 1
  // (R^4 + 4 R^3 r + 10 R^2 r^2 + 4 R r^3 + r^4) / S^2
  const Real along = slope * slope + 4 * slope * mixed + 8 * mixed * mixed;
  const Real across = axial / 2 + 3 * m * h * h * along / 80;
  return along_axes(mass, across, across, axial, h * (R * R + 2 * R * r + 3 * r * r) / (4 * S));
}

Record describe_frustum() {
  return with_volume(
      make_record<&frustum>(
          "frustum",
          "A solid cone round z whose tip is cut off: a tapered cylinder. The centre of its base is at the origin, its "
          "top at z = h. With S = R^2 + R r + r^2, the centre of mass is at z = h (R^2 + 2 R r + 3 r^2) / (4 S). About "
          "it: Iz = 3/10 m (R^4 + R^3 r + R^2 r^2 + R r^3 + r^4) / S, "
          "Ix = Iy = Iz / 2 + 3/80 m h^2 (R^4 + 4 R^3 r + 10 R^2 r^2 + 4 R r^3 + r^4) / S^2.",
          {{"mass", "mass [kg]"},
           {"base_radius", "R at z = 0 [m]"},
           {"top_radius", "r at z = h [m]; 0 is a cone"},
           {"height", "h [m]"}}),
      [](const double* v) -> Real {
        const Real R = v[0], r = v[1];
        return pi / 3 * (R * R + R * r + r * r) * v[2];
      });
}

}  // namespace polhode::shapes
