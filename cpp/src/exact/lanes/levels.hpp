#pragma once

#include "polhode/exact/free_kernels.hpp"

namespace polhode::exact {

/// Null where the compiler could not build the level.
const FreeKernels* baseline_free_kernels();
const FreeKernels* avx2_free_kernels();
const FreeKernels* avx512_free_kernels();

}  // namespace polhode::exact
