#include "batch/summary/kernels.hpp"

#include "core/choose_level.hpp"
#include "core/choose_once.hpp"

namespace polhode::summary {

const Kernels& kernels() {
  static constinit std::atomic<const Kernels*> chosen{nullptr};
  return choose_once(chosen, []() -> const Kernels& {
    return *choose_level(simd_level(), baseline_kernels, avx2_kernels, avx512_kernels);
  });
}

}  // namespace polhode::summary
