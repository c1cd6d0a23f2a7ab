#pragma once

#include <string>

#include "solve/effect/shares.hpp"

// From the integrals of a torque's size to bounds on what it changes.
namespace polhode::effect {

/// Bounds at every time of the span; infinite where a theorem does not apply, with the reason.
struct Bounds {
  double rate = HUGE_VAL;       ///< |w - w0| [rad/s]
  double rotation = HUGE_VAL;   ///< [rad]
  std::string refusal = {};
};

/// The change of y = J^1/2 w is d = int S (J^-1/2 tau + B(d, d)) ds with S along the motion without the torque. If
/// x = c kappa beta <= 1/4, beta = int |S J^-1/2| b, kappa = int |S|, then |d| <= u = beta (1 - sqrt(1 - 4 x)) / (2 x).
/// @param most_margin  of the rates, up to which the torque's size holds
Bounds bound_by_majorant(const FreeTable& table, const Share& share, double most_margin);

/// The same with the bounds on growth alone, in place of the columns: good for less than about a revolution.
/// @param size  of the torque for rates within `margin` of the free body's
Bounds bound_by_growth(const FreeBody& body, double size, double span);

/// Alekseev 1961; Groebner 1960: the change is int dF_{t-s}/dy(y(s)) J^-1/2 tau ds along the motion with the torque,
/// which stays within a tube about the free one. On the rotations the angle is at most the length of the path
/// s -> flow over t - s of the state at s.
Bounds bound_by_tube(const FreeTable& table, const Share& share, double most_margin);

}  // namespace polhode::effect
