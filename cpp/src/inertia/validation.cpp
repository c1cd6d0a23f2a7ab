#include "inertia/validation.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "polhode/core/error.hpp"
#include "polhode/core/float_state.hpp"
#include "polhode/inertia/inertia_tensor.hpp"

namespace polhode::inertia {
namespace {

std::string short_text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", value + 0.0);
  return buffer;
}

std::string per_cent(double part) { return short_text(100 * part) + " %"; }

const char* likely_cause(const Matrix3d& I_B, double deficit) {
  if (deficit < 1e-3) return "a flat body whose numbers were rounded? physical=False accepts them";
  const double d[3] = {I_B(0, 0), I_B(1, 1), I_B(2, 2)};
  const double sum = d[0] + d[1] + d[2];
  for (const double moment : d) {
    if (moment > sum - moment) return "a decimal point, a unit or the point of reference of one diagonal entry?";
  }
  return "the diagonal alone would do: the order of the products xy, xz, yz, their size, or the sign of one?";
}

}  // namespace

std::string vector_text(const Vector3d& v) {
  char buffer[96];
  std::snprintf(buffer, sizeof buffer, "(%.4g, %.4g, %.4g)", v[0] + 0.0, v[1] + 0.0, v[2] + 0.0);
  return buffer;
}

Matrix3d symmetrized(const Matrix3d& I_B, const char* where) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (!std::isfinite(I_B(i, j))) {
        throw InvalidInput(where, "finite",
                           to_text(I_B(i, j)) + " at [" + std::to_string(i) + ", " + std::to_string(j) + "]");
      }
      require_kept(I_B(i, j), where);
    }
  }
  const double largest = I_B.cwiseAbs().maxCoeff();
  for (int i = 0; i < 3; ++i) {
    for (int j = i + 1; j < 3; ++j) {
      const double difference = std::abs(0.5 * I_B(i, j) - 0.5 * I_B(j, i));  // halves: no overflow
      if (difference <= 0.5 * InertiaTensor::tolerance * largest) continue;
      const bool opposite = I_B(i, j) == -I_B(j, i), one_zero = I_B(i, j) == 0 || I_B(j, i) == 0;
      throw InvalidInput(where, "symmetric",
                         to_text(I_B(i, j)) + " at [" + std::to_string(i) + ", " + std::to_string(j) + "] and " +
                             to_text(I_B(j, i)) + " across, apart by " + per_cent(difference / largest * 2) +
                             " of the largest entry",
                         opposite   ? "a sign in one triangle?"
                         : one_zero ? "one triangle only? fill in both"
                                    : "a slip in one entry?");
    }
  }
  Matrix3d symmetric = I_B;
  for (int i = 0; i < 3; ++i) {
    for (int j = i + 1; j < 3; ++j) {
      if (I_B(i, j) == I_B(j, i)) continue;
      symmetric(i, j) = symmetric(j, i) = 0.5 * I_B(i, j) + 0.5 * I_B(j, i);
    }
  }
  return symmetric;
}

void check_moments(const Matrix3d& I_B, const PrincipalAxes& principal, bool physical, const char* where, double slack,
                   const char* cause) {
  const Vector3d& m = principal.moments;
  const double largest = std::max(std::abs(m[0]), std::abs(m[2]));
  const double allowed = InertiaTensor::tolerance * largest + slack;
  if (m[0] < -allowed) {
    const bool on_diagonal = std::min({I_B(0, 0), I_B(1, 1), I_B(2, 2)}) < 0;
    throw InvalidInput(where, "without negative moments",
                       to_text(m[0]) + " about the axis " + vector_text(principal.axes.col(0)) + ", " +
                           per_cent(-m[0] / largest) + " of the largest below zero",
                       cause         ? cause
                       : on_diagonal ? "a sign on the diagonal, or a difference taken the wrong way round?"
                                     : "products of inertia larger than the diagonal entries allow: a slip in one "
                                       "entry, or their order?");
  }
  const double excess = 0.5 * m[2] - 0.5 * m[1] - 0.5 * m[0];  // halves: no overflow
  if (physical && excess > 0.5 * allowed) {
    const double deficit = excess / (0.5 * m[2]);
    throw InvalidInput(where, "within the triangle inequality: no moment above the sum of the two others",
                       to_text(m[2]) + " about the axis " + vector_text(principal.axes.col(2)) + " against the sum " +
                           to_text(m[0] + m[1]) + ", a deficit of " + per_cent(deficit),
                       cause ? cause : likely_cause(I_B, deficit));
  }
}

double positive(double value, const char* where) {
  if (!(value > 0 && std::isfinite(value))) throw InvalidInput(where, "positive and finite", to_text(value));
  return value;
}

}  // namespace polhode::inertia
