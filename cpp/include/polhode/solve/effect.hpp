#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "polhode/scene/scene.hpp"

namespace polhode {

/// What a torque can do to a motion over its span, against the same motion without it.
struct Effect {
  double omega = 0.0;            ///< bound on the change of omega at any time of the span [rad/s]
  double attitude = 0.0;         ///< bound on the angle between the two attitudes [rad]
  double first_omega = 0.0;      ///< the same to first order in the torque, by the midpoint rule: no bound
  double first_attitude = 0.0;
  std::string refusal = {};      ///< why there is no bound; empty if there is one. The bounds are then infinite

  bool is_bounded() const { return refusal.empty(); }
};

/// A torque that the plan leaves out, with its part of the bound of all that are left out.
struct LeftOut {
  std::size_t torque;            ///< its number among the scene's torques
  std::string name;
  double omega;                  ///< relative to the rate of the start, and so at least to the largest rate
  double attitude;               ///< [rad]
  std::string reason;
};

/// Bounds the effect of one torque; all others stay. What remains must be a free body.
///
/// Alekseev 1961 and Groebner 1960: with the free flow F, the change of y = J^1/2 w at the time t is the integral of
/// dF_{t-s}/dy(y(s)) J^-1/2 tau(s). See docs/theory/left_out.md.
/// @throws InvalidInput for a number that is no torque of the scene
Effect compute_effect(const Scene& scene, std::size_t torque);

}  // namespace polhode
