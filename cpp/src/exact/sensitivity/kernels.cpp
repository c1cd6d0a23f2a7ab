#include "exact/sensitivity/kernels.hpp"

#include "core/choose_once.hpp"

namespace polhode::exact {

const FreeColumnsKernels& free_columns_kernels(SimdLevel level) {
  const FreeColumnsKernels* found = nullptr;
  if (level == SimdLevel::avx512) found = avx512_free_columns_kernels();
  if (found == nullptr && level != SimdLevel::baseline) found = avx2_free_columns_kernels();
  return found != nullptr ? *found : *baseline_free_columns_kernels();
}

const FreeColumnsKernels& free_columns_kernels() {
  static constinit std::atomic<const FreeColumnsKernels*> chosen{nullptr};
  return choose_once(chosen, []() -> const FreeColumnsKernels& { return free_columns_kernels(simd_level()); });
}

}  // namespace polhode::exact
