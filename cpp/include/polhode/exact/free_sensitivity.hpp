#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "polhode/exact/free_motion.hpp"

namespace polhode {

/// What a free motion is differentiated with respect to: three columns each, `time` one.
enum class SensitivityTo {
  omega,     ///< omega(0), in body axes
  attitude,  ///< a small rotation of the attitude at t = 0, on the same side as the result
  inertia,   ///< the principal moments at fixed omega(0): the caller's order, or ascending for a full tensor
  axes,      ///< a small rotation of the principal axes in the body, in body axes
  time,
};

/// Where a small rotation of the attitude R stands: exp(d theta_W) R in space axes, or R exp(d theta_B) in body axes.
enum class RotationSide { space, body };

/// Derivatives of a free motion, in closed form at any time and in every regime.
///
/// The size of a column is the larger of |d omega| / |omega(0)| and |d theta|. The error of a column is a few units of
/// rounding of its size. See docs/sensitivity.md.
class FreeSensitivity {
 public:
  /// Throws InvalidInput for an empty list or a name twice.
  FreeSensitivity(const FreeMotion& motion, std::vector<SensitivityTo> wrt, RotationSide side = RotationSide::space);

  std::size_t columns() const;  ///< their number

  /// n states, and their derivatives d omega and d theta (n, 3, columns), row by row; omega and attitude may be null.
  void at(const double* t, std::size_t n, double* omega, double* attitude, double* d_omega, double* d_attitude) const;

 private:
  class Body;
  std::shared_ptr<const Body> body_;
};

}  // namespace polhode
