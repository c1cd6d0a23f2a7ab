#pragma once

#include <cstddef>

#include "polhode/core/simd.hpp"
#include "polhode/exact/free_setup.hpp"
#include "polhode/exact/time_grid.hpp"

namespace polhode::exact {

/// What leads from the working frames back to the caller's: fixed for one body.
template <class T>
struct FreeFrameOf {
  T omega[9];       ///< omega = matrix omega', row by row, with the scale of time in it
  T attitude[16];   ///< the quaternion product with every fixed turn: q = matrix q'
  T time_scale;     ///< t' = t * time_scale, a power of two
};
using FreeFrame = FreeFrameOf<double>;

/// Moments (3), omega (3) and attitude (4) of many bodies, row by row.
struct FreeStarts {
  const double* moments;
  const double* omega;
  const double* attitude;
};

/// The loops, compiled for one instruction set. omega (n, 3) and attitude (n, 4) row by row; either may be null.
/// avx2 and avx512 give the same bits.
struct FreeKernels {
  TimeKernels times;

  /// One body at many times. A row's bits depend neither on n nor, off a grid, on its place.
  void (*trig)(const FreeTrig<double>&, const FreeFrame&, const TimeGrid&, double* omega, double* attitude);
  void (*hyper)(const FreeHyper<double>&, const FreeFrame&, const TimeGrid&, double* omega, double* attitude);

  /// n bodies, each at its own time: set up and evaluated in lanes. `left` gets the indices of those that this cannot
  /// do (exactly on the separatrix or the unstable axis, at rest, out of range); returns how many they are.
  std::size_t (*once)(FreeStarts starts, const double* t, std::size_t n, double* omega, double* attitude,
                      std::size_t* left);

  /// The constants of n bodies; `left` as for `once`, and those near the separatrix with them.
  std::size_t (*set_up)(FreeStarts starts, std::size_t n, FreeTrig<double>* trig, FreeFrame* frames, std::size_t* left);

  /// One body: its constants and, as k^2 <= 0.97 or beyond, `trig` or `hyper`. `start` is scaled as `analyse` asks.
  void (*prepare)(const FreeStart<double>& start, FreeConstants<double>& constants, FreeTrig<double>& trig,
                  FreeHyper<double>& hyper);
};

/// Those of a level; of the next lower one that was compiled.
const FreeKernels& free_kernels(SimdLevel level);

/// Those of simd_level(), decided once.
const FreeKernels& free_kernels();

}  // namespace polhode::exact
