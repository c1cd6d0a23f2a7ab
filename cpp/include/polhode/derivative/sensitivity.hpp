#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "polhode/exact/free_sensitivity.hpp"
#include "polhode/scene/scene.hpp"

namespace polhode {

struct SensitivityOptions {
  double accuracy = 1e-9;             ///< of each column relative to its size, 0 < accuracy <= 1
  bool certify = true;                ///< measure the error by a second run
  RotationSide side = RotationSide::space;    ///< of the small rotations, those of the start included
  long max_steps = 10'000'000;        ///< of one run
  std::uint64_t body = 0;             ///< its number among many, which decides what controllers draw
  bool rescale = false;               ///< beside controllers: multiply columns beyond float64's range by powers of two
};

/// The motion of a scene and its derivatives at the scene's times, row by row in their order.
struct MotionSensitivity {
  std::vector<std::string> columns;   ///< their names
  std::vector<double> omega, attitude;        ///< (n, 3) in body axes and (n, 4)
  std::vector<double> d_omega, d_attitude;    ///< (n, 3, columns)
  std::vector<double> d_states;               ///< (n, numbers of the states of formulas, columns)
  /// The error of each column relative to its size, the largest of all samples; empty without a certificate and for
  /// closed forms. It is four
  /// times the difference of the last two runs, and 4e-15 for each turn, of what both round alike.
  /// The size of a column in a sample is the larger of |d omega| / (largest |omega|) and the angle of the rotation. The
  /// error of a state's derivative is relative to its largest size in the motion.
  std::vector<double> error;
  /// Of each sample, with `rescale`: its derivatives are 2^scale times those here. Empty without controllers.
  std::vector<int> scale;
  std::string uncertain = {};         ///< in words: a branch of a controller that is not certain; "" if all are
  long steps = 0;                     ///< of all runs
  int runs = 0;
};

/// Differentiates a motion with respect to numbers of its scene: in closed form where the body is free and the groups are
/// among "omega", "attitude", "inertia" and "axes", else by its variational equations in Taylor series.
///
/// The columns are integrated beside the state, with the state's series and steps. Windows of torques and rotors cut
/// the span, and the columns of a window's ends start with the jump of the derivative there. A second run, with a
/// smaller tolerance, gives the result and measures the error. It is repeated until the error is below the accuracy, or
/// until float64 allows no smaller one.
/// @param groups  names as for find_parameters (polhode/scene/parameter.hpp), each once
/// @throws InvalidInput for unknown names, a torque without a formula, gravity gradients of two orbits, or an accuracy
///         out of range
/// @throws IntegrationFailure if a run does not reach its end
MotionSensitivity compute_sensitivity(const Scene& given, const std::vector<std::string>& groups,
                                      const SensitivityOptions& options = {});

}  // namespace polhode
