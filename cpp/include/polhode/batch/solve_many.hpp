#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "polhode/solve/solve.hpp"

namespace polhode {

/// The result of one body among many.
struct ManyResult {
  Status status = Status::finished;
  std::string message;
  std::string method;
  double t_reached = 0.0;
  double error = 0.0;         ///< NaN: not estimated
  long steps = 0;
  bool success = false;
  bool lanes = false;         ///< stepped in a lane beside other bodies, not alone
  bool refused = false;       ///< no motion, as the body is not one; `message` says why
};

/// Makes the scene of a body. It is called from several threads at once.
using MakeScene = std::function<Scene(std::size_t body)>;

/// Solves n scenes with `times` times each.
///
/// With a tolerance and the method "rk45" or "taylor", eight bodies are stepped side by side in the lanes of registers,
/// each with its own time, step and error. rk45 in lanes gives the bits of solve(). All other scenes, and those with a
/// Custom torque or windows of time, are solved one by one as by solve(). A result depends neither on the number of
/// threads (0: as many as the machine has) nor on the other bodies.
///
/// Writes omega (n, times, 3) and attitude (n, times, 4); either may be null. Rows that were not reached are NaN. A run
/// that fails does not affect the other bodies. `options.progress` gets the number of bodies done and n; it stops the
/// batch by returning false.
/// @param refuse  false: where make_scene throws InvalidInput, the rows of the body become NaN; its status is "failed"
/// @param numbers  of the bodies, which decide what controllers draw; by default 0, 1, ... from options.body on
/// @throws InvalidInput, with the number of the body, for what solve() refuses
std::vector<ManyResult> solve_many(std::size_t n, std::size_t times, const MakeScene& make_scene,
                                   const SolveOptions& options, double* omega, double* attitude, int threads = 0,
                                   bool refuse = true, std::span<const std::uint64_t> numbers = {});

}  // namespace polhode
