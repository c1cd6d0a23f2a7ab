#include "inertia/shapes/record.hpp"

namespace polhode::shapes {

MassProperties triangular_prism(double mass, const Triangle& vertices, double height) {
  const Real m = positive(mass, "mass"), h = positive(height, "height");
  Real edge[3][2], centre[2] = {0, 0};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 2; ++k) {
      if (!std::isfinite(vertices[i][k])) throw InvalidInput("vertices", "finite", to_text(vertices[i][k]));
      edge[i][k] = Real(vertices[i][k]) - vertices[0][k];  // from the first corner, see the tetrahedron
      centre[k] += edge[i][k] / 3;
    }
  }
  const Real area = edge[1][0] * edge[2][1] - edge[1][1] * edge[2][0];
  const auto length = [](const Real* v) { return std::sqrt(v[0] * v[0] + v[1] * v[1]); };   // no square overflows
  if (!(std::abs(area) > 1e-15L * length(edge[1]) * length(edge[2]))) {
    throw InvalidInput("vertices", "the corners of a triangle", "three points on one line");
  }
  Real xx = 0, yy = 0, xy = 0;
  for (const auto& e : edge) {
    const Real x = e[0] - centre[0], y = e[1] - centre[1];
    xx += m * x * x / 12;
    yy += m * y * y / 12;
    xy += m * x * y / 12;
  }
  const Real zz = m * h * h / 12;
  const auto in = [](Real value) { return static_cast<double>(value); };
  Matrix3d I_B;
  I_B << in(yy + zz), in(-xy), 0, in(-xy), in(xx + zz), 0, 0, 0, in(xx + yy);
  return MassProperties(mass, {in(vertices[0][0] + centre[0]), in(vertices[0][1] + centre[1]), 0}, InertiaTensor(I_B));
}

Record describe_triangular_prism() {
  return with_volume(make_record<&triangular_prism>(
      "triangular_prism",
      "A solid triangle in x, y, drawn out along z from -h/2 to h/2; its centre of mass is the mean of the corners. "
      "About the centre of mass: I_xx = m/12 (sum y^2 + h^2), I_xy = -m/12 sum x y, I_zz = m/12 sum (x^2 + y^2) over "
      "the corners, relative to it.",
      {{"mass", "mass [kg]"},
       {"vertices", "x, y of the three corners, in any order [m]"},
       {"height", "h along z [m]"}}),
                     [](const double* v) {
                       const Real ex = Real(v[2]) - v[0], ey = Real(v[3]) - v[1];
                       const Real fx = Real(v[4]) - v[0], fy = Real(v[5]) - v[1];
                       return std::abs(ex * fy - ey * fx) / 2 * v[6];
                     });
}

}  // namespace polhode::shapes
