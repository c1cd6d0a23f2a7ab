#pragma once

#include "polhode/core/simd.hpp"
#include "polhode/exact/detail/free_kernels.hpp"
#include "polhode/exact/detail/gyrostat_series.hpp"

namespace polhode::exact {

struct GyrostatStart;
struct GyrostatMotion;

/// The loops, compiled for one instruction set; avx2 and avx512 give the same bits.
struct GyrostatKernels {
  TimeKernels times;

  /// One body at many times, omega (n, 3) and attitude (n, 4) row by row; either may be null. A row's bits depend
  /// neither on n nor, off a grid, on its place.
  void (*at)(const GyrostatSeries&, const FreeFrame&, const TimeGrid&, double* omega, double* attitude);

  /// The constants of one body. Works in double-double throughout.
  void (*set_up)(const GyrostatStart&, GyrostatSeries&, GyrostatMotion&);
};

/// The kernels of a level, or of the next lower level that was compiled.
const GyrostatKernels& gyrostat_kernels(SimdLevel level);

/// The kernels of simd_level(), chosen once.
const GyrostatKernels& gyrostat_kernels();

}  // namespace polhode::exact
