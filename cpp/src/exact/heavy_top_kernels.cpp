#include "polhode/exact/detail/heavy_top_kernels.hpp"

#include "core/choose_level.hpp"
#include "core/choose_once.hpp"
#include "exact/lanes/levels.hpp"

namespace polhode::exact {

const HeavyTopKernels& heavy_top_kernels(SimdLevel level) {
  return *choose_level(level, baseline_heavy_top_kernels, avx2_heavy_top_kernels, avx512_heavy_top_kernels);
}

const HeavyTopKernels& heavy_top_kernels() {
  static constinit std::atomic<const HeavyTopKernels*> chosen{nullptr};
  return choose_once(chosen, []() -> const HeavyTopKernels& { return heavy_top_kernels(simd_level()); });
}

}  // namespace polhode::exact
