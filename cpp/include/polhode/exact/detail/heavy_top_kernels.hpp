#pragma once

#include "polhode/core/simd.hpp"
#include "polhode/exact/detail/heavy_top_kernel.hpp"
#include "polhode/exact/detail/time_grid.hpp"

namespace polhode::exact {

struct HeavyTopStart;
struct HeavyTopMotion;

/// The loops, compiled for one instruction set; avx2 and avx512 give the same bits.
struct HeavyTopKernels {
  TimeKernels times;

  /// One top at many times, omega (n, 3) and attitude (n, 4) row by row; either may be null. A row's bits depend
  /// neither on n nor, off a grid, on its place.
  void (*at)(const HeavyTopConstants&, const TimeGrid&, double* omega, double* attitude);

  /// Fills the motion and the constants, except rate_scale, q_SB and R_BS. Works in double-double throughout.
  void (*set_up)(const HeavyTopStart&, HeavyTopConstants&, HeavyTopMotion&);
};

/// The kernels of a level, or of the next lower level that was compiled.
const HeavyTopKernels& heavy_top_kernels(SimdLevel level);

/// The kernels of simd_level(), chosen once.
const HeavyTopKernels& heavy_top_kernels();

}  // namespace polhode::exact
