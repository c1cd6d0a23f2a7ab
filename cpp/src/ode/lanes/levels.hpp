#pragma once

#include "polhode/ode/series.hpp"

namespace polhode::ode {

/// Null where the compiler could not build the level.
const SeriesKernels* baseline_series_kernels();
const SeriesKernels* avx2_series_kernels();
const SeriesKernels* avx512_series_kernels();

}  // namespace polhode::ode
