#pragma once

#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "polhode/method/trajectory.hpp"
#include "polhode/scene/scene.hpp"

namespace polhode {

class ClosedForm;

/// One piece of a span that is cut where torques start or stop, or where the method is switched.
struct PiecePlan {
  double begin = 0.0, end = 0.0;       ///< [s], begin < end
  std::vector<std::string> torques = {};   ///< the names of the acting torques
  std::string model = {};              ///< a name of closed_forms(), or "euler"
  std::string method = {};             ///< "exact", or a name of ph.methods()
  double turns = 0.0;                  ///< expected revolutions
  double predicted_seconds = 0.0;      ///< including every run of the certificate
  double rtol_scale = 1.0;             ///< its tolerance over that of the plan's method
  /// The closed form or method that ran in its place, because the planned closed form did not hold at the piece's start.
  std::string ran = {};
};

/// The model and the method of a run. They are decided before the run and do not change afterwards.
struct Plan {
  std::string model;      ///< a name of closed_forms(), "euler", "lagrangian" or "pieces"
  std::string method;     ///< "exact" or a name of methods(); for pieces, the costliest method
  std::string state;      ///< the variables that are integrated: "omega", "omega, attitude", ...
  double accuracy = std::numeric_limits<double>::quiet_NaN();   ///< of the plan; NaN if tolerances were given
  bool certify = true;    ///< the error is bounded, not only expected
  bool proof = false;     ///< the error is proved: method "enclosure"
  double rtol = 0.0;      ///< of the run that is returned; 0 without steps
  double predicted_error = std::numeric_limits<double>::quiet_NaN();
  double predicted_seconds = std::numeric_limits<double>::quiet_NaN();
  std::vector<PiecePlan> pieces = {};   ///< in the order of time; empty if the span is not cut
};

/// The solution of a scene: attitude and angular velocity at its sample times, the plan, and the error.
struct Motion : Trajectory {
  int runs = 1;                          ///< two or more if the error was certified
  Plan plan;
  double rtol_used = 0.0;                ///< of the run that is returned, if an accuracy was requested; else 0
  double error = std::numeric_limits<double>::quiet_NaN();   ///< of all samples; NaN if not estimated
  std::string error_kind =
      "not estimated";                   ///< "bounded" | "proved" | "expected" | "estimated" | "limit" (above the accuracy) |
                                         ///< "not estimated"
  double asked = 0.0;                    ///< the requested accuracy, or the requested relative tolerance
  std::shared_ptr<const ClosedForm> closed_form = nullptr;   ///< replaces dense output if there is one
  std::vector<std::shared_ptr<const Motion>> pieces = {};    ///< replace dense output if the span is cut
  /// Of a proof: the exact motion of exactly the scene's numbers lies between these at every sample; rows as those of
  /// omega (n, 3) and attitude (n, 4, of the sign returned). They are infinite beyond the reach of the proof.
  std::vector<double> omega_lower = {}, omega_upper = {}, attitude_lower = {}, attitude_upper = {};
  /// The same of `states`.
  std::vector<double> states_lower = {}, states_upper = {};
  /// Of a proof: the times between which every sample has the accuracy [s].
  double proved_begin = std::numeric_limits<double>::quiet_NaN();
  double proved_end = std::numeric_limits<double>::quiet_NaN();
  /// Times at which a torque of the user's own was found to jump or kink; the span was divided there [s].
  std::vector<double> found_breaks = {};
  Vector3d end_jump = Vector3d::Zero();  ///< of omega, where rotors start or stop at the last time of the last piece
  double t_begin = 0.0;                  ///< start of the span of a closed form or a piece
  /// Of a chain of pieces: what ran in each, in the order of the run; "" as planned.
  std::vector<std::string> piece_runs = {};

  Motion() = default;
  explicit Motion(Trajectory trajectory) : Trajectory(std::move(trajectory)) {}

  /// The state at any time within the span, from dense output. @throws InvalidInput without dense=true.
  State at(double time) const;

  /// The largest |omega| of the start and the samples [rad/s], by which errors of omega are divided.
  double omega_scale() const;

  /// True if every number of every sample is finite.
  bool all_finite() const;
};

}  // namespace polhode
