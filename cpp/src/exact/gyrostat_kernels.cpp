#include "polhode/exact/detail/gyrostat_kernels.hpp"

#include "core/choose_once.hpp"
#include "exact/lanes/levels.hpp"

namespace polhode::exact {

const GyrostatKernels& gyrostat_kernels(SimdLevel level) {
  const GyrostatKernels* found = nullptr;
  if (level == SimdLevel::avx512) found = avx512_gyrostat_kernels();
  if (found == nullptr && level != SimdLevel::baseline) found = avx2_gyrostat_kernels();
  return found != nullptr ? *found : *baseline_gyrostat_kernels();
}

const GyrostatKernels& gyrostat_kernels() {
  static constinit std::atomic<const GyrostatKernels*> chosen{nullptr};
  return choose_once(chosen, []() -> const GyrostatKernels& { return gyrostat_kernels(simd_level()); });
}

}  // namespace polhode::exact
