#include "exact/sensitivity/kernels.hpp"

#include "core/choose_level.hpp"
#include "core/choose_once.hpp"

namespace polhode::exact {

const FreeColumnsKernels& free_columns_kernels(SimdLevel level) {
  return *choose_level(level, baseline_free_columns_kernels, avx2_free_columns_kernels, avx512_free_columns_kernels);
}

const FreeColumnsKernels& free_columns_kernels() {
  static constinit std::atomic<const FreeColumnsKernels*> chosen{nullptr};
  return choose_once(chosen, []() -> const FreeColumnsKernels& { return free_columns_kernels(simd_level()); });
}

}  // namespace polhode::exact
