#include "polhode/inertia/principal_axes.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "inertia/jacobi.hpp"
#include "inertia/validation.hpp"

namespace polhode {
namespace {

constexpr int X = 0, Y = 1, Z = 2;

/// The given axis a unit vector lies nearest to; of components equal to 1e-6 the first.
int nearest_axis(const Vector3d& v) {
  int k = X;
  if (std::abs(v[Y]) > std::abs(v[k]) + 1e-6) k = Y;
  if (std::abs(v[Z]) > std::abs(v[k]) + 1e-6) k = Z;
  return k;
}

Vector3d towards_nearest_axis(const Vector3d& v) {
  const double sign = v[nearest_axis(v)] < 0 ? -1.0 : 1.0;
  return (sign * v).array() + 0.0;  // no negative zeros
}

/// Normalises a vector that is unit to rounding.
Vector3d unit(const Vector3d& v) { return (1.5 - 0.5 * v.dot(v)) * v; }

Vector3d cross(const Vector3d& a, const Vector3d& b) {
  return {a[1] * b[2] - a[2] * b[1] + 0.0, a[2] * b[0] - a[0] * b[2] + 0.0, a[0] * b[1] - a[1] * b[0] + 0.0};
}

/// The given axis i under the smallest rotation that takes the given axis k (k != i) to the unit vector n.
Vector3d rotated_along(int i, int k, const Vector3d& n) {
  Vector3d v = -n[i] / (1 + n[k]) * n;
  v[k] -= n[i] / (1 + n[k]);
  v[i] += 1;
  return v.array() + 0.0;
}

Symmetry classify(const Vector3d& moments, double gap) {
  const double equal = gap * std::max(std::abs(moments[0]), std::abs(moments[2]));
  const bool low = moments[1] - moments[0] <= equal, high = moments[2] - moments[1] <= equal;
  // Both gaps are small but the sum of them is not: the closer pair counts as equal.
  if (moments[2] - moments[0] <= equal) return Symmetry::spherical;
  if (low && high) return moments[1] - moments[0] < moments[2] - moments[1] ? Symmetry::oblate : Symmetry::prolate;
  return low ? Symmetry::oblate : high ? Symmetry::prolate : Symmetry::triaxial;
}

/// Orders the moments and applies the rules of the header to Jacobi's frame V (columns, any order and sign).
PrincipalAxes arrange(const Vector3d& found, const Matrix3d& V, double gap) {
  int order[3] = {X, Y, Z};
  const auto swap_if = [&](int i, int j) {
    if (found[order[j]] < found[order[i]]) std::swap(order[i], order[j]);
  };
  swap_if(0, 1), swap_if(1, 2), swap_if(0, 1);

  PrincipalAxes result;
  for (int i = 0; i < 3; ++i) result.moments[i] = found[order[i]];
  result.symmetry = classify(result.moments, gap);
  auto& R_BP = result.axes;
  switch (result.symmetry) {
    case Symmetry::spherical:
      break;
    case Symmetry::oblate: {
      const Vector3d n = towards_nearest_axis(unit(V.col(order[2])));
      const int k = nearest_axis(n);
      R_BP.col(2) = n;
      R_BP.col(0) = rotated_along((k + 1) % 3, k, n);
      R_BP.col(1) = rotated_along((k + 2) % 3, k, n);
      break;
    }
    case Symmetry::prolate: {
      const Vector3d n = towards_nearest_axis(unit(V.col(order[0])));
      const int k = nearest_axis(n);
      R_BP.col(0) = n;
      R_BP.col(1) = rotated_along((k + 1) % 3, k, n);
      R_BP.col(2) = rotated_along((k + 2) % 3, k, n);
      break;
    }
    case Symmetry::triaxial: {
      const Vector3d low = unit(V.col(order[0])), high = V.col(order[2]);
      R_BP.col(0) = towards_nearest_axis(low);
      R_BP.col(2) = towards_nearest_axis(unit(high - low.dot(high) * low));
      R_BP.col(1) = cross(R_BP.col(2), R_BP.col(0));
      break;
    }
  }
  return result;
}

}  // namespace

const char* to_text(Symmetry symmetry) {
  switch (symmetry) {
    case Symmetry::spherical:
      return "spherical";
    case Symmetry::oblate:
      return "oblate";
    case Symmetry::prolate:
      return "prolate";
    case Symmetry::triaxial:
      break;
  }
  return "triaxial";
}

const char* to_text(Arbitrary arbitrary) {
  switch (arbitrary) {
    case Arbitrary::none:
      return "none";
    case Arbitrary::plane:
      return "plane";
    case Arbitrary::sphere:
      break;
  }
  return "sphere";
}

Arbitrary PrincipalAxes::arbitrary() const {
  if (symmetry == Symmetry::spherical) return Arbitrary::sphere;
  return symmetry == Symmetry::triaxial ? Arbitrary::none : Arbitrary::plane;
}

Vector3d PrincipalAxes::normal() const {
  if (symmetry == Symmetry::oblate) return axes.col(2);
  if (symmetry == Symmetry::prolate) return axes.col(0);
  return Vector3d::Zero();
}

PrincipalAxes compute_principal_axes(const Matrix3d& I_B, double gap) {
  inertia::Jacobi<1> solver;
  solver.load(0, I_B(0, 0), I_B(1, 1), I_B(2, 2), I_B(0, 1), I_B(0, 2), I_B(1, 2));
  solver.run();
  return arrange(solver.moments(0), solver.frame(0), gap);
}

std::size_t compute_principal_axes(const double* I_B, std::size_t count, double* moments, double* axes) {
  constexpr std::size_t lanes = 8;
  std::size_t not_finite = 0;
  for (std::size_t first = 0; first < count; first += lanes) {
    const std::size_t used = std::min(lanes, count - first);
    inertia::Jacobi<lanes> solver;
    bool finite[lanes] = {};
    for (std::size_t lane = 0; lane < used; ++lane) {
      const double* const m = I_B + 9 * (first + lane);
      double sum = 0;  // NaN when any entry is NaN or infinite
      for (int i = 0; i < 9; ++i) sum += 0 * m[i];
      finite[lane] = sum == 0;
      if (!finite[lane]) continue;
      if (m[1] == m[3] && m[2] == m[6] && m[5] == m[7]) {
        solver.load(lane, m[0], m[4], m[8], m[1], m[2], m[5]);
      } else {
        const std::string where = "matrices[" + std::to_string(first + lane) + "]";
        const Matrix3d s = inertia::symmetrized(Eigen::Map<const Matrix3d>(m).transpose(), where.c_str());
        solver.load(lane, s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(0, 2), s(1, 2));
      }
    }
    solver.run();
    for (std::size_t lane = 0; lane < used; ++lane) {
      double* const m = moments + 3 * (first + lane);
      double* const R = axes + 9 * (first + lane);
      if (!finite[lane]) {
        ++not_finite;
        std::fill_n(m, 3, std::numeric_limits<double>::quiet_NaN());
        std::fill_n(R, 9, std::numeric_limits<double>::quiet_NaN());
        continue;
      }
      const PrincipalAxes p = arrange(solver.moments(lane), solver.frame(lane), symmetry_gap);
      for (int i = 0; i < 3; ++i) m[i] = p.moments[i];
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) R[3 * i + j] = p.axes(i, j);
    }
  }
  return not_finite;
}

}  // namespace polhode
