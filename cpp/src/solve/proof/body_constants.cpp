#include "solve/proof/body_constants.hpp"

#include <algorithm>
#include <cmath>

#include "solve/proof/index.hpp"

namespace polhode::proof {
namespace {

Matrix make_matrix(const Matrix3d& m, double scale) {
  Matrix result;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      result[to_index(i)][to_index(j)] = Interval(m(i, j)) * Interval(scale);
  return result;
}

}  // namespace

Vector enclose_axis(const Rotor& rotor) {
  Vector a;
  for (std::size_t i = 0; i < 3; ++i) {
    const double component = rotor.axis()[static_cast<int>(i)];
    const bool exact = component == 0.0 || std::abs(component) == 1.0;
    a[i] = exact ? Interval(component) : Interval(math::DD(component), 0x1p-51 * std::abs(component));
  }
  return a;
}

Interval enclose_start_momentum(const Rotor& rotor, const Vector3d& w_B) {
  if (rotor.momentum()) return {*rotor.momentum()};
  const Vector a = enclose_axis(rotor);
  Interval speed(*rotor.speed());
  for (std::size_t i = 0; i < 3 && rotor.free(); ++i) speed = speed + a[i] * Interval(w_B[static_cast<int>(i)]);
  return Interval(*rotor.inertia()) * speed;
}

Vector enclose_momentum(const Rotor& rotor, const Vector3d& w_B) {
  if (rotor.is_driven()) return {};   // its momentum is a state
  const Vector a = enclose_axis(rotor);
  const Interval size = enclose_start_momentum(rotor, w_B);
  return {size * a[0], size * a[1], size * a[2]};
}

Matrix enclose_inertia(const Scene& scene, double part) {
  Matrix J = make_matrix(scene.given_inertia_B().matrix(), part);
  for (const Rotor& rotor : scene.rotors()) {
    if (!rotor.free() || !rotor.inertia()) continue;
    const Vector a = enclose_axis(rotor);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        J[i][j] = J[i][j] - Interval(*rotor.inertia()) * Interval(part) * a[i] * a[j];
  }
  for (std::size_t i = 0; i < 3 && scene.damper(); ++i)
    J[i][i] = J[i][i] - Interval(scene.damper()->inertia()) * Interval(part);
  return J;
}

Matrix invert(const Matrix& m) {
  Matrix inverse;
  if (m[0][1].is_zero() && m[0][2].is_zero() && m[1][2].is_zero()) {
    for (std::size_t i = 0; i < 3; ++i) inverse[i][i] = Interval(1.0) / m[i][i];
    return inverse;
  }
  const auto minor = [&](std::size_t i, std::size_t j) {   // of row j and column i, signed
    const std::size_t a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
    return m[a][c] * m[b][d] - m[a][d] * m[b][c];
  };
  const Interval determinant = m[0][0] * minor(0, 0) + m[0][1] * minor(1, 0) + m[0][2] * minor(2, 0);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) inverse[i][j] = minor(i, j) / determinant;
  return inverse;
}

std::array<Matrix, 3> enclose_products(const Matrix& I) {
  std::array<Matrix, 3> products = {};
  for_permutations([&](int i, int j, int k, double s) {
    for (int l = 0; l < 3; ++l) {
      auto& sum = products[to_index(i)][to_index(std::min(j, l))][to_index(std::max(j, l))];
      sum = sum + Interval(s) * I[to_index(k)][to_index(l)];
    }
  });
  return products;
}

}  // namespace polhode::proof
