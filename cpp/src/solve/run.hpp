#pragma once

#include <functional>
#include <memory>

#include "polhode/ode/stepper.hpp"
#include "polhode/solve/solve.hpp"

namespace polhode {

namespace ode {
struct ErrorTrace;
}

/// What remains of the options once they have been checked.
struct RunOptions {
  const SolveOptions& asked;
  ode::Tolerances tolerances;
  ode::ErrorTrace* trace = nullptr;   ///< where the method carries its error along (BodyMethod::carries_error)
};

/// omega and the unit attitude of n states, row by row; outlives the run where the dense output is kept.
using Unpack = std::function<void(const double* rows, std::size_t n, double* omega, double* attitude)>;
/// From a function of one state of `dimension` numbers.
template <int dimension, class UnpackOne>
Unpack by_rows(UnpackOne unpack_one) {
  return [unpack_one](const double* rows, std::size_t n, double* omega, double* attitude) {
    for (std::size_t i = 0; i < n; ++i) unpack_one(rows + dimension * i, omega + 3 * i, attitude + 4 * i);
  };
}
/// A stepper from the start state towards t_end.
using MakeStepper = std::function<std::unique_ptr<ode::Stepper>(const double* y0, double t_end)>;

/// Both directions of time, samples, events and dense output into a Motion, whatever the method and the problem.
Motion run(const Scene& scene, const SolveOptions& options, const double* y0, const Unpack& unpack,
           const MakeStepper& make_stepper);

}  // namespace polhode
