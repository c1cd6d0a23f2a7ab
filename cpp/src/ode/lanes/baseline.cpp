// For any processor.
#define POLHODE_ISA isa_baseline
#include "ode/lanes/levels.hpp"
#include "ode/lanes/series_loops.hpp"

namespace polhode::ode {
const SeriesKernels* baseline_series_kernels() { return &POLHODE_ISA::series_kernels; }
}  // namespace polhode::ode
