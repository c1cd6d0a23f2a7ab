#pragma once

#include <cstddef>

#include "polhode/core/simd.hpp"
#include "polhode/exact/free_series.hpp"

namespace polhode::exact {

/// What leads from the working frames back to the caller's: fixed for one body.
struct FreeFrame {
  double omega[9] = {};       ///< omega = matrix omega', row by row, with the scale of time in it
  double attitude[16] = {};   ///< the quaternion product with every fixed turn: q = matrix q'
  double time_scale = 1.0;    ///< t' = t * time_scale, a power of two
};

/// The loops over times of one body, compiled for one instruction set. omega (n, 3) and attitude (n, 4) row by row;
/// either may be null. An element's bits depend neither on n nor on its place; avx2 and avx512 give the same.
struct FreeKernels {
  void (*trig)(const FreeTrig<double>&, const FreeFrame&, const double* t, std::size_t n, double* omega, double* attitude);
  void (*hyper)(const FreeHyper<double>&, const FreeFrame&, const double* t, std::size_t n, double* omega, double* attitude);
};

/// Those of a level; of the next lower one that was compiled.
const FreeKernels& free_kernels(SimdLevel level);

/// Those of simd_level(), decided once.
const FreeKernels& free_kernels();

}  // namespace polhode::exact
