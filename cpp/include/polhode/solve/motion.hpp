#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "polhode/method/trajectory.hpp"
#include "polhode/scene/scene.hpp"

namespace polhode {

class ClosedForm;

/// One piece of a span that is cut where torques begin or cease to act, or where the method is switched.
struct PiecePlan {
  double begin = 0.0, end = 0.0;       ///< [s], begin < end
  std::vector<std::string> torques = {};   ///< the names of those that act
  std::string model = {};              ///< a name of exact_models(), or "euler"
  std::string method = {};             ///< "exact", or a name of ph.methods()
  double turns = 0.0;                  ///< expected revolutions
  double predicted_seconds = 0.0;      ///< with every run of the certificate
  double rtol_scale = 1.0;             ///< of its tolerance, to that of the plan's method
};

/// Which model and method were taken. It is decided before the run and not changed afterwards.
struct Plan {
  std::string model;      ///< a name of exact_models(), "euler", "lagrangian", or "pieces": see there
  std::string method;     ///< "exact", or a name of ph.methods(): of pieces, the one that has most to do
  std::string state;      ///< the variables that are integrated: "omega", "omega, attitude", ...
  double accuracy = std::numeric_limits<double>::quiet_NaN();   ///< that was planned for; NaN: tolerances were given
  bool certify = true;    ///< the error is to be bounded, not only expected
  double rtol = 0.0;      ///< planned for the run that is returned; 0 where there are no steps
  double predicted_error = std::numeric_limits<double>::quiet_NaN();
  double predicted_seconds = std::numeric_limits<double>::quiet_NaN();
  std::vector<PiecePlan> pieces = {};   ///< in the order of time; empty where the span is not cut
};

/// The answer: where the body points and how fast it spins at the times asked for, with its plan and its error.
struct Motion : Trajectory {
  int runs = 1;                          ///< two or more where the error was certified
  Plan plan;
  double rtol_used = 0.0;                ///< of the run that is returned, where an accuracy was asked; else 0
  double error = std::numeric_limits<double>::quiet_NaN();   ///< of all samples; NaN: not estimated
  std::string error_kind =
      "not estimated";                   ///< "bounded" | "expected" | "limit" (more than was asked) | "not estimated"
  double asked = 0.0;                    ///< the accuracy, or the relative tolerance, that was asked for
  std::shared_ptr<const ClosedForm> closed_form = nullptr;   ///< in place of dense output, where there is one
  std::vector<std::shared_ptr<const Motion>> pieces = {};    ///< in place of dense output, where the span is cut
  double t_begin = 0.0;                  ///< of a closed form's span, or a piece's

  Motion() = default;
  explicit Motion(Trajectory trajectory) : Trajectory(std::move(trajectory)) {}

  /// The state at any time within the span, from the continuous extension. @throws InvalidInput without dense=true.
  State at(double time) const;
};

}  // namespace polhode
