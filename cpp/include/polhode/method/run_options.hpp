#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "polhode/core/state.hpp"
#include "polhode/ode/problem.hpp"

namespace polhode {

namespace ode {
struct ErrorTrace;
}

/// A function of time and state whose zeros are located.
struct SceneEvent {
  std::function<double(const State&)> function;
  int direction = 0;       ///< +1: zeros where it rises along the integration, -1: where it falls, 0: both
  bool terminal = false;   ///< the run ends at its first zero
};

/// Euler's equations, or Lagrange's in the textbook's z-x-z angles, which fail at theta = 0 and pi.
enum class Formulation { euler, lagrangian };

/// Called about twenty times a second with the time reached and the last time; false ends the run.
using Progress = std::function<bool(double reached, double last)>;

/// How one method integrates one scene.
struct RunOptions {
  ode::Tolerances tolerances = {};
  long max_steps = 10'000'000;
  bool dense = false;                           ///< keep the continuous extension
  Formulation formulation = Formulation::euler;
  std::span<const SceneEvent> events = {};      ///< owned by the caller
  Progress progress = {};
  std::uint64_t body = 0;                       ///< its number among many, which decides what controllers draw
  bool keep_ticks = true;                       ///< of controllers
  ode::ErrorTrace* trace = nullptr;             ///< for methods with BodyMethod::carries_error
};

}  // namespace polhode
