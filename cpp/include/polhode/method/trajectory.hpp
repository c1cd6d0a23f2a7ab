#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "polhode/core/state.hpp"
#include "polhode/ode/dense_output.hpp"
#include "polhode/ode/problem.hpp"

namespace polhode {

/// How a run ended.
enum class Status { finished, event, max_steps, stopped, failed };
std::string_view to_text(Status status);

struct MotionEvent {
  int event;              ///< index of the event in the list that was given
  State state;
};

/// omega and the unit attitude of n states, row by row. It outlives the run where the dense output is kept.
using Unpack = std::function<void(const double* rows, std::size_t n, double* omega, double* attitude)>;

/// What one method makes of one scene: the samples, in the order asked for, and how the run ended.
/// Times that were not reached are left out. `omega` is (n, 3) and `attitude` (n, 4), row by row, empty when not wanted.
struct Trajectory {
  std::vector<double> t, omega, attitude;
  Status status = Status::finished;
  std::string message;
  ode::Counts stats;
  std::string model = {};                ///< "euler" or "lagrangian" where equations are stepped
  std::string state = {};                ///< the variables that were integrated: "omega", "omega, attitude", ...
  std::vector<MotionEvent> events;
  ode::DenseOutput dense_forward, dense_backward;
  bool has_dense = false;
  Unpack unpack;                         ///< of the dense states
  State start;
  double t_reached = 0.0;
};

}  // namespace polhode
