#pragma once

#include <functional>
#include <string>
#include <vector>

#include "solve/ground/pieces.hpp"
#include "solve/proof/body_equations.hpp"
#include "solve/proof/taylor_step.hpp"

namespace polhode::proof {

struct EncloseOptions {
  StepSettings step = {};
  long max_steps = 10'000'000;
  double widest = 1e-3;            ///< it ends where its half-width is larger, relative to the rates and to 1
  std::function<bool(double)> go_on = {};   ///< asked every 64 steps with the time reached; false ends the enclosure
};

/// Sets that hold the exact motion at a scene's times: omega (n, 3) in rad/s and the attitude (n, 4), which runs on
/// from the start without a change of sign. The states of formulas follow in the order of Scene::states(). Where the
/// enclosure ended before, all are unbounded.
struct Enclosure {
  std::vector<Interval> omega, attitude, states;
  double begin = 0.0, end = 0.0;   ///< the times between which the motion is enclosed [s]
  Status status = Status::finished;   ///< failed: the bounds became too wide, which is no failure of the motion
  std::string ended = {};          ///< why it ended early, in words
  double ended_at = 0.0;           ///< and when [s]
  long steps = 0, rejected = 0;
};

/// Encloses the exact motion of a scene from exactly its float64 numbers.
/// @param pieces  of the scene, in which the same torques act; none of them a Custom
Enclosure enclose(const Scene& scene, const Pieces& pieces, const EncloseOptions& options);

}  // namespace polhode::proof
