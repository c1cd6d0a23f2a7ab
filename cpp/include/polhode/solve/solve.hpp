#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "polhode/method/run_options.hpp"
#include "polhode/solve/motion.hpp"

namespace polhode {

/// The time of each method or exact model on this machine over its forecast, by name. A missing name counts as 1.
using CostFactors = std::map<std::string, double, std::less<>>;

struct SolveOptions {
  std::optional<double> accuracy = {};    ///< of every sample, 0 < accuracy <= 1; excludes rtol and atol
  std::optional<std::string> method = {}; ///< "exact" or a name of methods(); the plan chooses if left out
  bool certify = true;                    ///< bound the error, which is otherwise only expected
  bool proof = false;                     ///< bounds that are theorems: see Motion::omega_lower
  std::optional<double> rtol = {};        ///< relative tolerance of a step
  std::optional<double> atol = {};        ///< absolute tolerance of a step, in rad/s and in quaternion components
  std::optional<double> step = {};        ///< [s], for fixed-step methods only
  long max_steps = 10'000'000;
  bool dense = false;                     ///< keep the continuous extension, for motion.at(t)
  Formulation formulation = Formulation::euler;
  std::vector<SceneEvent> events = {};
  bool leave_out = true;                  ///< torques that change nothing within a third of the accuracy: see effect.hpp
  const CostFactors* cost_factors = nullptr;   ///< for the choice between methods
  Progress progress = {};
  std::uint64_t body = 0;                 ///< its number among many, which decides what controllers draw
  bool keep_ticks = true;                 ///< of controllers, in Motion::ticks
};

/// Computes the rotational motion of a scene at its sample times.
/// @throws InvalidInput for options that contradict each other. Exceptions of a torque pass through.
Motion solve(const Scene& scene, const SolveOptions& options = {});

/// False if the run did not reach its end, or its error exceeds the requested accuracy. If the error is not estimated,
/// the drift of each invariant is compared with the requested tolerance.
bool succeeded(const Scene& scene, const Motion& motion);

}  // namespace polhode
