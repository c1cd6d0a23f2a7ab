#pragma once

#include <cmath>
#include <cstddef>

#include "polhode/core/simd.hpp"
#include "polhode/ode/detail/step_control.hpp"

namespace polhode::ode {

/// Numbers of one row of a series of a body: the k-th Taylor coefficients of up to eight components. Unused ones are
/// zero. A body with further states has rows of several times eight.
inline constexpr int series_width = 8;
inline constexpr int most_series_width = 64;
inline constexpr int most_series_order = 40;

/// Evaluates a series at many points at once, compiled for one instruction set; avx2 and avx512 give the same bits.
struct SeriesKernels {
  /// out_i = base + (rest + sum over k >= 1 of rows[k] s_i^k), n rows of eight. Rows begin `stride` numbers apart.
  void (*evaluate)(const double* rows, int order, int stride, const double* base, const double* rest, const double* s,
                   std::size_t n, double* out);
};

/// Those of simd_level(), decided once.
const SeriesKernels& series_kernels();
const SeriesKernels& series_kernels(SimdLevel level);

/// The same with rows of `width` numbers, a multiple of eight.
inline void evaluate_series(const double* rows, int order, int width, const double* base, const double* rest,
                            const double* s, std::size_t n, double* out) {
  for (int i = 0; i < width; i += series_width)
    series_kernels().evaluate(rows + i, order, width, base + i, rest + i, s, n, out + i);
}

}  // namespace polhode::ode
