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
/// `sliding`: a formula's switch holds the motion on its surface, where the formula has no value.
enum class Status { finished, event, max_steps, stopped, failed, sliding };
std::string_view to_text(Status status);

struct MotionEvent {
  int event;              ///< index of the event in the list that was given
  State state;
};

/// Computes omega and the unit attitude of n states, row by row. It outlives the run if dense output is kept.
using Unpack = std::function<void(const double* rows, std::size_t n, double* omega, double* attitude)>;

/// Where the numbers of further states stand in the rows of a run: raw, behind the body's.
struct ExtraStates {
  int count = 0;
  int first = 8, row = 8;   ///< the first column, and the numbers of a row

  std::vector<double> of(const double* y) const { return {y + first, y + first + count}; }
};

/// What a controller did at its ticks, row by row.
struct Ticks {
  std::vector<double> t;
  std::vector<double> measurement;   ///< omega, attitude, and the field and the speeds if they are measured
  std::vector<double> command;       ///< of the tick, which acts after the delay
  std::vector<double> states;        ///< new numbers of the controller's states
};

/// The result of one run: the samples, in the order of the scene's times, and how the run ended. Times that were not
/// reached are left out. `omega` is (n, 3) and `attitude` (n, 4), row by row; they are empty if not requested.
struct Trajectory {
  std::vector<double> t, omega, attitude;
  std::vector<double> states = {};       ///< (n, extra.count), of torques that have any
  ExtraStates extra = {};
  Status status = Status::finished;
  std::string message;
  ode::Counts stats;
  std::string model = {};                ///< "euler" or "lagrangian" if equations were integrated
  std::string state = {};                ///< the integrated variables: "omega", "omega, attitude", ...
  std::vector<MotionEvent> events;
  ode::DenseOutput dense_forward, dense_backward;
  bool has_dense = false;
  Unpack unpack;                         ///< for the states of dense output
  State start;
  double t_reached = 0.0;
  std::vector<Ticks> ticks = {};         ///< of the scene's controllers
};

}  // namespace polhode
