#pragma once

#include <memory>
#include <string>

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
