#include "polhode/exact/detail/free_kernels.hpp"

#include "core/choose_level.hpp"
#include "core/choose_once.hpp"
#include "exact/lanes/levels.hpp"

namespace polhode::exact {

const FreeKernels& free_kernels() {
  static constinit std::atomic<const FreeKernels*> chosen{nullptr};
  return choose_once(chosen, []() -> const FreeKernels& {
    return *choose_level(simd_level(), baseline_free_kernels, avx2_free_kernels, avx512_free_kernels);
  });
}

const FreeBatchKernels& free_batch_kernels() {
  static constinit std::atomic<const FreeBatchKernels*> chosen{nullptr};
  return choose_once(chosen, []() -> const FreeBatchKernels& {
    return *choose_level(simd_level(), baseline_free_batch_kernels, avx2_free_batch_kernels, avx512_free_batch_kernels);
  });
}

const DampedKernels& damped_kernels() {
  static constinit std::atomic<const DampedKernels*> chosen{nullptr};
  return choose_once(chosen, []() -> const DampedKernels& {
    return *choose_level(simd_level(), baseline_damped_kernels, avx2_damped_kernels, avx512_damped_kernels);
  });
}

}  // namespace polhode::exact
