#pragma once

#include "polhode/exact/free_kernels.hpp"
#include "polhode/exact/heavy_top_kernels.hpp"

namespace polhode::exact {

/// Null where the compiler could not build the level.
const FreeKernels* baseline_free_kernels();
const FreeKernels* avx2_free_kernels();
const FreeKernels* avx512_free_kernels();
HeavyTopLoop baseline_heavy_top_loop();
HeavyTopLoop avx2_heavy_top_loop();
HeavyTopLoop avx512_heavy_top_loop();

}  // namespace polhode::exact
