#pragma once

#include "polhode/core/quat.hpp"

namespace polhode {

/// Where a body points and how it spins at one time.
struct State {
  double t = 0.0;                        ///< [s]
  Vector3d omega = Vector3d::Zero();     ///< w_B, angular velocity in body axes [rad/s]
  Quat attitude;                         ///< q_WB, unit
};

}  // namespace polhode
