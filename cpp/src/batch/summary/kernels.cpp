#include "batch/summary/kernels.hpp"

#include "core/choose_once.hpp"

namespace polhode::summary {

const Kernels& kernels() {
  static constinit std::atomic<const Kernels*> chosen{nullptr};
  return choose_once(chosen, []() -> const Kernels& {
    const Kernels* found = nullptr;
    if (simd_level() == SimdLevel::avx512) found = avx512_kernels();
    if (found == nullptr && simd_level() != SimdLevel::baseline) found = avx2_kernels();
    return found != nullptr ? *found : *baseline_kernels();
  });
}

}  // namespace polhode::summary
