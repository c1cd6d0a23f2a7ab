#include "polhode/ode/series.hpp"

#include "core/choose_level.hpp"
#include "core/choose_once.hpp"
#include "ode/lanes/levels.hpp"

namespace polhode::ode {

const SeriesKernels& series_kernels(SimdLevel level) {
  return *choose_level(level, baseline_series_kernels, avx2_series_kernels, avx512_series_kernels);
}

const SeriesKernels& series_kernels() {
  static constinit std::atomic<const SeriesKernels*> chosen{nullptr};
  return choose_once(chosen, []() -> const SeriesKernels& { return series_kernels(simd_level()); });
}

}  // namespace polhode::ode
