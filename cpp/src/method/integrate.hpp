#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "polhode/method/run_options.hpp"
#include "polhode/method/trajectory.hpp"
#include "polhode/ode/drive.hpp"
#include "polhode/ode/stepper.hpp"
#include "polhode/scene/scene.hpp"

namespace polhode {

/// Makes an Unpack from a function that unpacks one state of `dimension` numbers.
template <int dimension, class UnpackOne>
Unpack by_rows(UnpackOne unpack_one) {
  return [unpack_one](const double* rows, std::size_t n, double* omega, double* attitude) {
    for (std::size_t i = 0; i < n; ++i) unpack_one(rows + dimension * i, omega + 3 * i, attitude + 4 * i);
  };
}

/// Makes a stepper from the start state towards t_end.
using MakeStepper = std::function<std::unique_ptr<ode::Stepper>(const double* y0, double t_end)>;

/// The state that a row of numbers is.
using ToState = std::function<State(double t, const double* y)>;

/// The events of a scene as functions of rows. They refer to `events`.
/// @throws InvalidInput from a function that gives NaN
std::vector<ode::Event> make_events(std::span<const SceneEvent> events, const ToState& to_state);

/// How a run ended, in words.
struct EndingText {
  Status status;
  std::string message;
};
EndingText describe_ending(ode::Ending ending, double t, long max_steps);

/// Integrates a scene in both directions of time and collects samples, events and dense output. It works for any method
/// and any variables.
Trajectory integrate(const Scene& scene, const RunOptions& options, const double* y0, const Unpack& unpack,
                     const MakeStepper& make_stepper, const ExtraStates& extra = {});

}  // namespace polhode
