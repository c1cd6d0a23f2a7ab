#include "polhode/ode/series.hpp"

#include "ode/lanes/levels.hpp"

namespace polhode::ode {

const SeriesKernels& series_kernels(SimdLevel level) {
  const SeriesKernels* found = nullptr;
  if (level == SimdLevel::avx512) found = avx512_series_kernels();
  if (found == nullptr && level != SimdLevel::baseline) found = avx2_series_kernels();
  return found != nullptr ? *found : *baseline_series_kernels();
}

const SeriesKernels& series_kernels() {
  static const SeriesKernels& chosen = series_kernels(simd_level());
  return chosen;
}

}  // namespace polhode::ode
