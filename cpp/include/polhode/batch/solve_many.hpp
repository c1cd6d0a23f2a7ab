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
};

/// The scene of body i; called from several threads at once.
using MakeScene = std::function<Scene(std::size_t body)>;

/// Solves n scenes with `times` times each, every one as solve() does by itself: the result does not depend on the
/// number of threads (0: as many as the machine has) nor on how the bodies are divided. Writes omega (n, times, 3) and
/// attitude (n, times, 4), either may be null; rows that were not reached are NaN. A body whose run fails does so alone;
/// `options.progress` gets the number of bodies done and n, and ends all by returning false.
/// @throws InvalidInput, with the number of the body, for what solve() refuses
std::vector<ManyResult> solve_many(std::size_t n, std::size_t times, const MakeScene& make_scene, const SolveOptions& options,
                                   double* omega, double* attitude, int threads = 0);

}  // namespace polhode
