#include "exact/sensitivity/kernels.hpp"

namespace polhode::exact {

const FreeColumnsKernels& free_columns_kernels(SimdLevel level) {
  const FreeColumnsKernels* found = nullptr;
  if (level == SimdLevel::avx512) found = avx512_free_columns_kernels();
  if (found == nullptr && level != SimdLevel::baseline) found = avx2_free_columns_kernels();
  return found != nullptr ? *found : *baseline_free_columns_kernels();
}

const FreeColumnsKernels& free_columns_kernels() {
  static const FreeColumnsKernels& chosen = free_columns_kernels(simd_level());
  return chosen;
}

}  // namespace polhode::exact
