#include "polhode/exact/detail/gyrostat_kernels.hpp"

#include "core/choose_level.hpp"
#include "core/choose_once.hpp"
#include "exact/lanes/levels.hpp"

namespace polhode::exact {

const GyrostatKernels& gyrostat_kernels(SimdLevel level) {
  return *choose_level(level, baseline_gyrostat_kernels, avx2_gyrostat_kernels, avx512_gyrostat_kernels);
}

const GyrostatKernels& gyrostat_kernels() {
  static constinit std::atomic<const GyrostatKernels*> chosen{nullptr};
  return choose_once(chosen, []() -> const GyrostatKernels& { return gyrostat_kernels(simd_level()); });
}

}  // namespace polhode::exact
