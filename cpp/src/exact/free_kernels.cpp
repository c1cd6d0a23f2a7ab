#include "polhode/exact/detail/free_kernels.hpp"

#include "core/choose_once.hpp"
#include "exact/lanes/levels.hpp"

namespace polhode::exact {

const FreeKernels& free_kernels(SimdLevel level) {
  const FreeKernels* found = nullptr;
  if (level == SimdLevel::avx512) found = avx512_free_kernels();
  if (found == nullptr && level != SimdLevel::baseline) found = avx2_free_kernels();
  return found != nullptr ? *found : *baseline_free_kernels();
}

const FreeKernels& free_kernels() {
  static constinit std::atomic<const FreeKernels*> chosen{nullptr};
  return choose_once(chosen, []() -> const FreeKernels& { return free_kernels(simd_level()); });
}

}  // namespace polhode::exact
