#pragma once

#include <limits>
#include <vector>

#include "polhode/scene/scene.hpp"
#include "polhode/method/trajectory.hpp"

// Probes the user's own torques between the stages of steps. A pulse that no stage sees leaves no trace in a run.
namespace polhode {

/// What the probes found.
struct Probes {
  std::vector<double> breaks = {};   ///< times at which a torque jumps or kinks in every state [s], sorted
  /// A time near which a torque jumps with the state [s]; NaN: none was found.
  double state_jump = std::numeric_limits<double>::quiet_NaN();
  bool too_many = false;             ///< more breaks than are located
};

/// Times between two others, in order, at most 1/1000 of the span apart and not evenly spaced.
std::vector<double> spread_probes(double begin, double end);

/// Compares the torques at neighbouring probes, and locates their jumps and kinks in time by bisection.
/// @param motion    with omega, and with the attitude if a torque depends on it
/// @param first     the row of the first probe in `motion`; all later rows are probes
/// @param accuracy  jumps that matter less are left alone
Probes probe(const Scene& scene, const Trajectory& motion, std::size_t first, double accuracy);

}  // namespace polhode
