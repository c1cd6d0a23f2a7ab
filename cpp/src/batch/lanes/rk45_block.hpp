#pragma once

#include "batch/lanes/lane_state.hpp"

namespace polhode {

/// One torque of eight bodies: what torque/formulas.hpp asks for, number by number.
struct alignas(64) LaneTorque {
  enum class Kind { body_constant, space_constant, weight, gradient, damping };
  LaneClock::Row values[9] = {};
  Kind kind = Kind::body_constant;
};

/// Eight bodies in steps of rk45, each with its own constants.
struct Rk45Block : LaneClock {
  // of all eight
  double rtol = 0.0, atol = 0.0;
  int torque_count = 0;
  const LaneTorque* torques = nullptr;

  // constants of a body: the tensor and its inverse by columns, or what principal axes leave of them
  alignas(64) Row inertia[9] = {};
  Row inverse[9] = {}, difference[3] = {}, inverse_moment[3] = {};

  // state: (w, q) and its derivative, the step to be tried, and what ode::StepControl keeps
  Row y[7] = {}, f[7] = {}, step = {}, log_previous = {}, rejected = {}, not_finite = {};
  // the last step that a lane called after: its begin, its length and its continuous extension
  Row time_old = {}, step_taken = {}, segment[5][7] = {};
};

struct Rk45Kernels {
  /// Steps until a lane with a body calls, at most so many times: because a sample lies behind it, because it cannot go
  /// on, or because it has made its steps. The bits of those that call.
  unsigned (*advance)(Rk45Block& block, int rounds);
  /// y at the fractions s of the last step, in the lanes that called.
  void (*sample)(const Rk45Block& block, const double* s, double (*y)[LaneClock::width]);
};

/// Null where the compiler could not build the level.
Rk45Kernels avx2_rk45_lanes(bool diagonal, bool attitude);
Rk45Kernels avx512_rk45_lanes(bool diagonal, bool attitude);
Rk45Kernels baseline_rk45_lanes(bool diagonal, bool attitude);

}  // namespace polhode
