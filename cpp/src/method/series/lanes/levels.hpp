#pragma once

#include "method/series/series_terms.hpp"

namespace polhode {

/// What a step starts from, in units of time of `unit` (a power of two).
struct SeriesStart {
  const double* y;          ///< (r0, r1, r2, 0 | x, y, z, w), or with a vector in place of the quaternion
  const double* vectors;    ///< four numbers each: those fixed in space, then radius and tangent of the orbit
  double unit;
};

/// Rows 0..order, which is at least 4, of eight numbers: the Taylor coefficients of y in powers of t / unit.
using SeriesKernel = void (*)(const SeriesTerms& terms, const SeriesStart& start, int order, double* rows);

/// `attitude`: the quaternion is carried; else nothing but the rates, or one fixed vector beside them.
SeriesKernel find_series_kernel(const SeriesTerms& terms, bool attitude);

/// Null where the compiler could not build the level.
SeriesKernel baseline_series_kernel(const SeriesTerms& terms, bool attitude);
SeriesKernel avx2_series_kernel(const SeriesTerms& terms, bool attitude);
SeriesKernel avx512_series_kernel(const SeriesTerms& terms, bool attitude);

}  // namespace polhode
