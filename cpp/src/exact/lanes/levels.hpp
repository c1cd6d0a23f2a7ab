#pragma once

#include "polhode/exact/detail/free_kernels.hpp"
#include "polhode/exact/detail/gyrostat_kernels.hpp"
#include "polhode/exact/detail/heavy_top_kernels.hpp"

namespace polhode::exact {

/// Null where the compiler could not build the level.
const FreeKernels* baseline_free_kernels();
const FreeKernels* avx2_free_kernels();
const FreeKernels* avx512_free_kernels();
const FreeBatchKernels* baseline_free_batch_kernels();
const FreeBatchKernels* avx2_free_batch_kernels();
const FreeBatchKernels* avx512_free_batch_kernels();
const DampedKernels* baseline_damped_kernels();
const DampedKernels* avx2_damped_kernels();
const DampedKernels* avx512_damped_kernels();
const HeavyTopKernels* baseline_heavy_top_kernels();
const HeavyTopKernels* avx2_heavy_top_kernels();
const HeavyTopKernels* avx512_heavy_top_kernels();
const GyrostatKernels* baseline_gyrostat_kernels();
const GyrostatKernels* avx2_gyrostat_kernels();
const GyrostatKernels* avx512_gyrostat_kernels();

}  // namespace polhode::exact
