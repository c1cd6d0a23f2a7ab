#pragma once

#include <vector>

#include "polhode/core/quat.hpp"

namespace polhode {

/// Where a body points and how it spins at one time.
struct State {
  double t = 0.0;                        ///< [s]
  Vector3d omega = Vector3d::Zero();     ///< w_B, angular velocity in body axes [rad/s]
  Quat attitude;                         ///< q_WB, unit
  std::vector<double> states = {};       ///< those of torques, in the order of list_states()
};

}  // namespace polhode
