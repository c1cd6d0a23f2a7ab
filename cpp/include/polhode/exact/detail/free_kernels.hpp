#pragma once

#include <cstddef>

#include "polhode/core/simd.hpp"
#include "polhode/exact/detail/free_setup.hpp"
#include "polhode/exact/detail/time_grid.hpp"

namespace polhode::exact {

/// The maps from the working frames to the caller's frames, constant for one body.
template <class T>
struct FreeFrameOf {
  T omega[9];       ///< omega = matrix omega', row by row, including the scale of time
  T attitude[16];   ///< q = matrix q': the quaternion products with all constant rotations
  T time_scale;     ///< t' = t * time_scale, a power of two
};
using FreeFrame = FreeFrameOf<double>;

/// Whether floats hold the rates of the frame.
inline bool suits_single(const FreeFrame& frame) { return frame.time_scale > 0x1p-60 && frame.time_scale < 0x1p60; }

/// Moments (3), omega (3) and attitude (4) of many bodies, row by row.
struct FreeStarts {
  const double* moments;
  const double* omega;
  const double* attitude;
};

/// The loops, compiled for one instruction set. omega (n, 3) and attitude (n, 4) row by row; either may be null.
/// avx2 and avx512 give the same bits. There are three tables, so that a program links only those that it calls.
struct FreeKernels {
  TimeKernels times;

  /// One body at many times. A row's bits depend neither on n nor, off a grid, on its place.
  void (*trig)(const FreeTrig<double>&, const FreeFrame&, const TimeGrid&, double* omega, double* attitude);
  void (*hyper)(const FreeHyper<double>&, const FreeFrame&, const TimeGrid&, double* omega, double* attitude);

  /// One body: its constants, and `trig` for k^2 <= 0.97 or `hyper` beyond. `start` is scaled as `analyse` requires.
  void (*prepare)(const FreeStart<double>& start, FreeConstants<double>& constants, FreeTrig<double>& trig,
                  FreeHyper<double>& hyper);
};

/// What only the many bodies of `batch` need.
struct FreeBatchKernels {
  /// FreeKernels::trig in floats, with the phases reduced in double: within 1e-6 of the largest |omega| and of the attitude. The
  /// frame must suit. A row's bits depend neither on n nor on its place.
  void (*trig_single)(const FreeTrig<double>&, const FreeFrame&, const double* t, std::size_t n, float* omega,
                      float* attitude);

  /// What a vector (3) becomes by the rotations of n attitudes, row by row, or by their inverses.
  void (*rotate)(const double* vector, const double* attitude, std::size_t n, bool inverse, double* rotated);
  /// n numbers, rounded to floats.
  void (*narrow)(const double* numbers, std::size_t n, float* rounded);

  /// n bodies, each at its own time: set up and evaluated in lanes. `left` receives the indices of bodies that are not
  /// done (exactly on the separatrix or the unstable axis, at rest, out of range). Returns their number.
  std::size_t (*once)(FreeStarts starts, const double* t, std::size_t n, double* omega, double* attitude,
                      std::size_t* left);

  /// The constants of n bodies; `left` as for `once`, and also bodies near the separatrix.
  std::size_t (*set_up)(FreeStarts starts, std::size_t n, FreeTrig<double>* trig, FreeFrame* frames, std::size_t* left);
};

/// One body under the torque -c I omega, c != 0, at n times.
struct DampedKernels {
  void (*trig)(const FreeTrig<double>&, const FreeFrame&, double c, const double* t, std::size_t n, double* omega,
               double* attitude);
  void (*hyper)(const FreeHyper<double>&, const FreeFrame&, double c, const double* t, std::size_t n, double* omega,
                double* attitude);
  /// The slowed times s = (1 - e^-ct) / c = hi + lo, and e^-ct (n each).
  void (*slow)(double c, const double* t, std::size_t n, double* hi, double* lo, double* decay);
};

/// The kernels of simd_level(), or of the next lower level that was compiled; chosen once.
const FreeKernels& free_kernels();
const FreeBatchKernels& free_batch_kernels();
const DampedKernels& damped_kernels();

}  // namespace polhode::exact
