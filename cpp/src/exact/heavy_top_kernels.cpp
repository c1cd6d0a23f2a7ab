#include "polhode/exact/detail/heavy_top_kernels.hpp"

#include "exact/lanes/levels.hpp"

namespace polhode::exact {

const HeavyTopKernels& heavy_top_kernels(SimdLevel level) {
  const HeavyTopKernels* found = nullptr;
  if (level == SimdLevel::avx512) found = avx512_heavy_top_kernels();
  if (found == nullptr && level != SimdLevel::baseline) found = avx2_heavy_top_kernels();
  return found != nullptr ? *found : *baseline_heavy_top_kernels();
}

const HeavyTopKernels& heavy_top_kernels() {
  static const HeavyTopKernels& chosen = heavy_top_kernels(simd_level());
  return chosen;
}

}  // namespace polhode::exact
