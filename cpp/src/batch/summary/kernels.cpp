#include "batch/summary/kernels.hpp"

namespace polhode::summary {

const Kernels& kernels() {
  static const Kernels& chosen = []() -> const Kernels& {
    const Kernels* found = nullptr;
    if (simd_level() == SimdLevel::avx512) found = avx512_kernels();
    if (found == nullptr && simd_level() != SimdLevel::baseline) found = avx2_kernels();
    return found != nullptr ? *found : *baseline_kernels();
  }();
  return chosen;
}

}  // namespace polhode::summary
