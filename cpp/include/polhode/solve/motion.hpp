#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "polhode/core/state.hpp"
#include "polhode/ode/dense_output.hpp"
#include "polhode/ode/problem.hpp"
#include "polhode/scene/scene.hpp"

namespace polhode {

class ClosedForm;

/// How a solve ended.
enum class Status { finished, event, max_steps, stopped, failed };
std::string_view to_text(Status status);

/// One piece of a span that is cut where torques begin or cease to act.
struct PiecePlan {
  double begin = 0.0, end = 0.0;       ///< [s], begin < end
  std::vector<std::string> torques = {};   ///< the names of those that act
  std::string model = {};              ///< a name of exact_models(), or "euler"
  std::string method = {};             ///< "exact", or a name of ph.methods()
  double turns = 0.0;                  ///< expected
  double predicted_seconds = 0.0;      ///< with every run of the certificate
  double rtol_scale = 1.0;             ///< of its tolerance, to that of the plan's method
  bool handed_over = false;            ///< it begins where another method pays, not where torques change
};

/// Which model and method were taken.
struct Plan {
  std::string model;      ///< a name of exact_models(), "euler", "lagrangian", or "pieces": see there
  std::string method;     ///< "exact", or a name of ph.methods(): of pieces, the one that has most to do
  std::string state;      ///< what is carried along: "omega", "omega, attitude", ...
  double accuracy = std::numeric_limits<double>::quiet_NaN();   ///< that was planned for; NaN: tolerances were given
  bool certify = true;    ///< the error is to be bounded, not only expected
  double rtol = 0.0;      ///< of the run that is returned; 0 where there are no steps
  double predicted_error = std::numeric_limits<double>::quiet_NaN();
  double predicted_seconds = std::numeric_limits<double>::quiet_NaN();
  std::vector<PiecePlan> pieces = {};   ///< in the order of time; empty where the span is not cut
};

struct MotionEvent {
  int event;              ///< index of the event in the list that was given
  State state;
};

/// The answer: where the body points and how fast it spins, at the times asked for, in the order asked for.
/// Times that were not reached are left out. `omega` is (n, 3) and `attitude` (n, 4), row by row, empty when not
/// wanted.
struct Motion {
  std::vector<double> t, omega, attitude;
  Status status = Status::finished;
  std::string message;
  ode::Counts stats;                     ///< of all runs together
  int runs = 1;                          ///< two or more where the error was certified
  Plan plan;
  double error = std::numeric_limits<double>::quiet_NaN();   ///< of all samples; NaN: not estimated
  std::string error_kind =
      "not estimated";                   ///< "bounded" | "expected" | "limit" (more than was asked) | "not estimated"
  double asked = 0.0;                    ///< the accuracy, or the relative tolerance, that was asked for
  std::vector<MotionEvent> events;
  ode::DenseOutput dense_forward, dense_backward;
  bool has_dense = false;
  std::shared_ptr<const ClosedForm> closed_form = nullptr;   ///< in place of dense output, where there is one
  std::vector<std::shared_ptr<const Motion>> pieces = {};    ///< in place of dense output, where the span is cut
  /// Dense states, n rows, as omega and attitude.
  std::function<void(const double* rows, std::size_t n, double* omega, double* attitude)> unpack;
  State start;
  double t_reached = 0.0;
  double t_begin = 0.0;                  ///< of a closed form's span, or a piece's

  /// The state at any time within the span, from the continuous extension. @throws InvalidInput without dense=true.
  State at(double time) const;
};

}  // namespace polhode
