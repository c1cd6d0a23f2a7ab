#pragma once

#include <span>
#include <string>
#include <vector>

#include "polhode/solve/effect.hpp"

// The effect of torques that act together on a free body.
namespace polhode::effect {

/// The bounds of all together, and the part of each, in the order given.
struct Together {
  Effect all;
  std::vector<double> omega, attitude;   ///< they add up to the bounds
};

/// Bounds what some torques do together to the free body that remains without them. The scene may have no other torque
/// that acts, and no rotors.
/// @param enough  a cruder bound is taken, in a few microseconds, if it is below this: omega relative to the start's
///                rate, the attitude in rad
Together bound_together(const Scene& scene, std::span<const std::size_t> torques, double enough = 0.0);

}  // namespace polhode::effect
