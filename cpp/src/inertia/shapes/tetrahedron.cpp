#include "inertia/shapes/record.hpp"

namespace polhode::shapes {
namespace {

/// Refuses four corners that lie in one plane to the precision of double.
void require_volume(const Real (&e)[4][3]) {
  const Real volume = e[1][0] * (e[2][1] * e[3][2] - e[2][2] * e[3][1]) +
                      e[1][1] * (e[2][2] * e[3][0] - e[2][0] * e[3][2]) +
                      e[1][2] * (e[2][0] * e[3][1] - e[2][1] * e[3][0]);
  Real box = 1;
  for (int i = 1; i < 4; ++i) box *= std::sqrt(e[i][0] * e[i][0] + e[i][1] * e[i][1] + e[i][2] * e[i][2]);
  if (!(std::abs(volume) > 1e-15L * box)) {
    throw InvalidInput("vertices", "the corners of a tetrahedron", "four points in one plane");
  }
}

}  // namespace

MassProperties tetrahedron(double mass, const Tetrahedron& vertices) {
  const Real m = positive(mass, "mass");
  for (const Vector3d& v : vertices) {
    if (!v.allFinite()) throw InvalidInput("vertices", "finite", inertia::vector_text(v));
  }
  // Relative to the first corner, so that a distant origin costs no digits.
  Real edge[4][3], centre[3] = {0, 0, 0};
  for (int i = 0; i < 4; ++i) {
    for (int k = 0; k < 3; ++k) {
      edge[i][k] = Real(vertices[i][k]) - vertices[0][k];
      centre[k] += edge[i][k] / 4;
    }
  }
  require_volume(edge);
  Real C[3][3] = {};  // integral of the product of two coordinates, about the centre
  for (const auto& e : edge) {
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) C[j][k] += m * (e[j] - centre[j]) * (e[k] - centre[k]) / 20;
  }
  Matrix3d I_B;
  for (int j = 0; j < 3; ++j) {
    for (int k = 0; k < 3; ++k) I_B(j, k) = static_cast<double>(-C[j][k]);
    I_B(j, j) = static_cast<double>(C[(j + 1) % 3][(j + 1) % 3] + C[(j + 2) % 3][(j + 2) % 3]);
  }
  Vector3d com;
  for (int k = 0; k < 3; ++k) com[k] = static_cast<double>(vertices[0][k] + centre[k]);
  return MassProperties(mass, com, InertiaTensor(I_B));
}

Record describe_tetrahedron() {
  return with_volume(make_record<&tetrahedron>(
      "tetrahedron",
      "A solid tetrahedron with any four corners; its centre of mass is their mean. "
      "About the centre of mass: I_xx = m/20 sum (y^2 + z^2), I_xy = -m/20 sum x y over the corners, relative to it.",
      {{"mass", "mass [kg]"}, {"vertices", "x, y, z of the four corners, in any order [m]"}}),
                     [](const double* v) {
                       Real e[3][3];
                       for (int i = 0; i < 3; ++i)
                         for (int k = 0; k < 3; ++k) e[i][k] = Real(v[3 * i + 3 + k]) - v[k];
                       return std::abs(e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) +
                                       e[0][1] * (e[1][2] * e[2][0] - e[1][0] * e[2][2]) +
                                       e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) / 6;
                     });
}

}  // namespace polhode::shapes
