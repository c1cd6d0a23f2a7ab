#include "inertia/shapes/record.hpp"

namespace polhode::shapes {

MassProperties box(double mass, const Vector3d& half_sides) {
  const Real m = positive(mass, "mass");
  positive(half_sides, "half_sides");
  const Real aa = Real(half_sides[0]) * half_sides[0], bb = Real(half_sides[1]) * half_sides[1],
             cc = Real(half_sides[2]) * half_sides[2];
  return along_axes(mass, m * (bb + cc) / 3, m * (cc + aa) / 3, m * (aa + bb) / 3);
}

Record describe_box() {
  return with_volume(
      make_record<&box>("box",
                           "A solid block with sides 2a, 2b, 2c along x, y, z. "
                           "Ix = m (b^2 + c^2) / 3, and cyclically.",
                           {{"mass", "mass [kg]"}, {"half_sides", "a, b, c: half of each side [m]"}}),
      [](const double* v) -> Real { return Real(8) * v[0] * v[1] * v[2]; });
}

}  // namespace polhode::shapes
