#include <algorithm>

#include "inertia/shapes/record.hpp"

// A point of the surface is (a n_x, b n_y, c n_z) with a unit vector n, and its area is in proportion to
// g = sqrt(x n_x^2 + y n_y^2 + z n_z^2), where x = 1/a^2, y = 1/b^2, z = 1/c^2. Write <> for the mean over all n. Then
// <g> = R_G(x, y, z) (DLMF 19.16.3), and 2 d<g>/dx = <n_x^2 / g>. The mean of the Laplacian of a function that is
// homogeneous of degree 3 is 12 times its own mean; for g^3, with the equations of Euler and Poisson, it gives
// <n_x^2 g> = <g> / 4 + x <n_x^2 / g> / 4. Here <n_x^2 / g> = (y R_D(z, x, y) + z R_D(x, y, z)) / 6 (DLMF 19.16.5 and
// 19.21.8), and <g> is the sum of x <n_x^2 / g> over the axes. All terms are positive: nothing cancels.
namespace polhode::shapes {
namespace {

/// R_D(x, y, z) by duplication, for positive arguments (Carlson 1995, Numer. Algorithms 10, 13).
Real carlson_rd(Real x, Real y, Real z) {
  Real sum = 0, power = 1;
  for (;;) {
    const Real mean = (x + y + 3 * z) / 5;
    const Real X = (mean - x) / mean, Y = (mean - y) / mean, Z = -(X + Y) / 3;
    if (std::max({std::abs(X), std::abs(Y), std::abs(Z)}) < Real(5e-4)) {
      const Real E2 = X * Y - 6 * Z * Z, E3 = (3 * X * Y - 8 * Z * Z) * Z, E4 = 3 * (X * Y - Z * Z) * Z * Z,
                 E5 = X * Y * Z * Z * Z;
      const Real series = 1 - 3 * E2 / 14 + E3 / 6 + 9 * E2 * E2 / 88 - 3 * E4 / 22 - 9 * E2 * E3 / 52 + 3 * E5 / 26;
      return 3 * sum + power * series / (mean * std::sqrt(mean));
    }
    const Real rx = std::sqrt(x), ry = std::sqrt(y), rz = std::sqrt(z), lambda = rx * ry + rx * rz + ry * rz;
    sum += power / (rz * (z + lambda));
    power /= 4;
    x = (x + lambda) / 4, y = (y + lambda) / 4, z = (z + lambda) / 4;
  }
}

}  // namespace

MassProperties ellipsoid_shell(double mass, const Vector3d& semi_axes) {
  const Real m = positive(mass, "mass");
  positive(semi_axes, "semi_axes");
  const Real largest = semi_axes.maxCoeff();
  Real inverse[3], part[3], mean = 0;  // 1/a^2, then its part of the mean of g, relative to the largest axis
  for (int i = 0; i < 3; ++i) {
    const Real ratio = largest / semi_axes[i];
    inverse[i] = ratio * ratio;
  }
  Real weighted[3];
  for (int i = 0; i < 3; ++i) {
    weighted[i] = inverse[i] * carlson_rd(inverse[(i + 1) % 3], inverse[(i + 2) % 3], inverse[i]);
  }
  for (int i = 0; i < 3; ++i) {
    part[i] = inverse[i] * (weighted[(i + 1) % 3] + weighted[(i + 2) % 3]);
    mean += part[i];
  }
  Real second[3];
  for (int i = 0; i < 3; ++i) second[i] = m * semi_axes[i] * semi_axes[i] * (1 + part[i] / mean) / 4;
  return along_axes(mass, second[1] + second[2], second[2] + second[0], second[0] + second[1]);
}

Record describe_ellipsoid_shell() {
  return make_record<&ellipsoid_shell>(
      "ellipsoid_shell",
      "A thin shell in the form of an ellipsoid with semi-axes a, b, c along x, y, z, of one density per area. With "
      "g = sqrt((n_x/a)^2 + (n_y/b)^2 + (n_z/c)^2) for unit vectors n, and their means p_x = <(n_x/a)^2/g> / <g>: "
      "Ix = m (b^2 (1 + p_y) + c^2 (1 + p_z)) / 4, and cyclically, by elliptic integrals.",
      {{"mass", "mass [kg]"}, {"semi_axes", "a, b, c [m]"}});
}

}  // namespace polhode::shapes
