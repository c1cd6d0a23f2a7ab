#pragma once

#include "method/series/series_terms.hpp"

namespace polhode {

/// The state at the start of a step, in units of time of `unit`, a power of two.
struct SeriesStart {
  const double* y;          ///< (r0, r1, r2, 0 | x, y, z, w), or a vector in place of the quaternion
  const double* vectors;    ///< four numbers each: vectors fixed in space, then radius and tangent of the orbit
  double unit;
};

/// Computes rows 0..order of eight numbers: the Taylor coefficients of y in powers of t / unit. `order` is at least 4.
using SeriesKernel = void (*)(const SeriesTerms& terms, const SeriesStart& start, int order, double* rows);

/// @param attitude  the quaternion is integrated; else the rates alone, or the rates and one fixed vector
SeriesKernel find_series_kernel(const SeriesTerms& terms, bool attitude);

/// Null if the compiler could not build the instruction set.
SeriesKernel baseline_series_kernel(const SeriesTerms& terms, bool attitude);
SeriesKernel avx2_series_kernel(const SeriesTerms& terms, bool attitude);
SeriesKernel avx512_series_kernel(const SeriesTerms& terms, bool attitude);

}  // namespace polhode
