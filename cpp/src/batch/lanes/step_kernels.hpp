#pragma once

#include <cstddef>

#include "polhode/batch/step.hpp"

namespace polhode {

/// The loops of step_bodies() for bodies [begin, end), compiled for each instruction set.
struct StepKernels {
  void (*run_f)(const StepBatch<float>& batch, std::size_t begin, std::size_t end);
  void (*run_d)(const StepBatch<double>& batch, std::size_t begin, std::size_t end);
};

/// Null where the compiler could not build the level.
const StepKernels* baseline_step_lanes();
const StepKernels* avx2_step_lanes();
const StepKernels* avx512_step_lanes();

}  // namespace polhode
