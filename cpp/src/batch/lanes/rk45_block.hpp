#pragma once

#include "batch/lanes/lane_state.hpp"

namespace polhode {

/// One torque of eight bodies, or their rotors: the arguments of its formula in torque/formulas.hpp, one row a number.
struct alignas(64) LaneTorque {
  enum class Kind { body_constant, space_constant, weight, gradient, damping, rotors };
  LaneState::Row values[9] = {};
  Kind kind = Kind::body_constant;
};

/// Eight bodies stepped by rk45, each with its own constants.
struct Rk45Block : LaneState {
  // common to all lanes
  double rtol = 0.0, atol = 0.0;
  int torque_count = 0;
  const LaneTorque* torques = nullptr;

  // constants of a body: the tensor and its inverse by columns; for a diagonal tensor
  // `difference` and `inverse_moment` replace the inverse
  alignas(64) Row inertia[9] = {};
  Row inverse[9] = {}, difference[3] = {}, inverse_moment[3] = {};

  // state: (w, q), its derivative, the next step to try, and the memory of ode::StepControl
  Row y[7] = {}, f[7] = {}, step = {}, log_previous = {}, rejected = {}, not_finite = {};
  // the last step that needed the host: its start, its length and its continuous extension
  Row time_old = {}, step_taken = {}, segment[5][7] = {};
};

struct Rk45Kernels {
  explicit operator bool() const { return advance != nullptr; }

  /// As LaneIntegrator::advance.
  unsigned (*advance)(Rk45Block& block, int rounds);
  /// y at the fractions s of the last step, for the lanes that needed the host.
  void (*sample)(const Rk45Block& block, const double* s, double (*y)[LaneState::width]);
};

/// Null where the compiler could not build the level.
Rk45Kernels avx2_rk45_lanes(bool diagonal, bool attitude);
Rk45Kernels avx512_rk45_lanes(bool diagonal, bool attitude);
Rk45Kernels baseline_rk45_lanes(bool diagonal, bool attitude);

}  // namespace polhode
