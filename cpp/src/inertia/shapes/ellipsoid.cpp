#include "inertia/shapes/record.hpp"

namespace polhode::shapes {

MassProperties ellipsoid(double mass, const Vector3d& semi_axes) {
  const Real m = positive(mass, "mass");
  positive(semi_axes, "semi_axes");
  const Real aa = Real(semi_axes[0]) * semi_axes[0], bb = Real(semi_axes[1]) * semi_axes[1],
             cc = Real(semi_axes[2]) * semi_axes[2];
  return along_axes(mass, m * (bb + cc) / 5, m * (cc + aa) / 5, m * (aa + bb) / 5);
}

Record describe_ellipsoid() {
  return with_volume(
      make_record<&ellipsoid>("ellipsoid",
                                 "A solid ellipsoid with semi-axes a, b, c along x, y, z. "
                                 "Ix = m (b^2 + c^2) / 5, and cyclically.",
                                 {{"mass", "mass [kg]"}, {"semi_axes", "a, b, c [m]"}}),
      [](const double* v) -> Real { return 4 * pi / 3 * v[0] * v[1] * v[2]; });
}

}  // namespace polhode::shapes
