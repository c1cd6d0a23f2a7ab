#include "polhode/exact/heavy_top_kernels.hpp"

#include "exact/lanes/levels.hpp"

namespace polhode::exact {

HeavyTopLoop heavy_top_loop(SimdLevel level) {
  HeavyTopLoop found = nullptr;
  if (level == SimdLevel::avx512) found = avx512_heavy_top_loop();
  if (found == nullptr && level != SimdLevel::baseline) found = avx2_heavy_top_loop();
  return found != nullptr ? found : baseline_heavy_top_loop();
}

HeavyTopLoop heavy_top_loop() {
  static const HeavyTopLoop chosen = heavy_top_loop(simd_level());
  return chosen;
}

}  // namespace polhode::exact
