#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "polhode/solve/solve.hpp"

namespace polhode {

/// What becomes of one body among many.
struct ManyResult {
  Status status = Status::finished;
  std::string message;
  std::string method;
  double t_reached = 0.0;
  double error = 0.0;         ///< NaN: not estimated
  long steps = 0;
  bool success = false;
  bool lanes = false;         ///< stepped side by side with others, not by itself
};

/// The scene of body i; called from several threads at once.
using MakeScene = std::function<Scene(std::size_t body)>;

/// Solves n scenes with `times` times each. With a tolerance and method "rk45" (to the bits of solve()) or "taylor"
/// eight bodies are stepped side by side in the lanes of registers, each with its own time, step and error; else, and
/// with a Custom torque, every one as solve() does by itself. A result depends neither on the number of threads (0: as
/// many as the machine has), nor on the other bodies, nor on how they are divided. Writes omega (n, times, 3) and
/// attitude (n, times, 4), either may be null; rows that were not reached are NaN. A body whose run fails does so
/// alone; `options.progress` gets the number of bodies done and n, and ends all by returning false.
/// @throws InvalidInput, with the number of the body, for what solve() refuses
std::vector<ManyResult> solve_many(std::size_t n, std::size_t times, const MakeScene& make_scene,
                                   const SolveOptions& options, double* omega, double* attitude, int threads = 0);

}  // namespace polhode
