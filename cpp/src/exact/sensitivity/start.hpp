#pragma once

#include "exact/free_frame.hpp"

namespace polhode::exact {

/// A body as the columns need it. Vectors are scaled as in FreeMotion: omega = 2^time_exponent w.
struct ColumnsStart {
  Matrix3d R_BP = Matrix3d::Identity();
  Vector3d I{1, 1, 1}, w{0, 0, 0};   ///< principal axes, scaled
  Vector3d omega{0, 0, 0};           ///< body axes, as given
  Quat attitude;
  int time_exponent = 0, moment_exponent = 0;
};

/// Scaled omega in principal axes.
inline Vector3d to_principal(const ColumnsStart& start, const Vector3d& omega) {
  return start.R_BP.transpose() * ldexp(omega, -start.time_exponent);
}

}  // namespace polhode::exact
