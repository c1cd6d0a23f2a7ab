#pragma once

#include <cstddef>
#include <cstdint>

#include "polhode/core/simd.hpp"

namespace polhode::summary {

constexpr std::size_t lanes = 8;   ///< rows of times are padded to whole vectors
constexpr std::size_t tile = 64;   ///< bodies whose numbers are gathered before they are added up
constexpr std::size_t span = 256;  ///< times that are evaluated at once: two blocks of a grid

inline std::size_t padded(std::size_t n) { return (n + lanes - 1) / lanes * lanes; }

/// Vectors that belong to the times: components in planes. A constant one has `lanes` equal entries a plane.
struct TimeVectors {
  const double* planes;
  std::size_t stride;    ///< from plane to plane
  std::size_t step;      ///< 1, or 0 for a constant
};

/// Where the numbers of one scalar are added up: rows of times, and bins a time.
struct ScalarSums {
  double *count, *sum, *sum2, *least, *largest;
  std::uint32_t* bins;   ///< a row for each time; its last entry is for NaN
  std::size_t row;       ///< entries of a row
  double first, last;    ///< numbers below `first` are in bin 0 (or the middle), from `last` on in the outermost
  bool both_signs;
};

/// The loops, compiled for one instruction set; avx2 and avx512 give the same bits. n is a multiple of `lanes`.
struct Kernels {
  /// The angle between attitudes (n, 4) and the nominal ones [rad].
  void (*angle)(const double* attitude, TimeVectors nominal, std::size_t n, double* values);
  /// The angle between a body axis in space and a target [rad].
  void (*axis_angle)(const double* attitude, const double* axis, TimeVectors target, std::size_t n, double* values);
  /// |omega| of rows (n, 3) [rad/s].
  void (*rate)(const double* omega, std::size_t n, double* values);
  /// The kinetic energy for the tensor xx, yy, zz, xy, xz, yz [J].
  void (*energy)(const double* omega, const double* tensor, std::size_t n, double* values);
  /// conj(nominal) q in four planes, `stride` apart.
  void (*deviation)(const double* attitude, TimeVectors nominal, std::size_t n, double* planes, std::size_t stride);

  /// Adds rows of `bodies` (stride `span`) in order. What is not finite is left out. `times` may be any number.
  void (*add)(const double* values, std::size_t bodies, std::size_t times, ScalarSums sums);
  /// Adds the ten products of the components of quaternions, four planes a body; `plane` is the stride of the sums.
  void (*add_products)(const double* planes, std::size_t bodies, std::size_t times, double* count, double* products,
                       std::size_t plane);
};

/// Null where the compiler could not build the level.
const Kernels* baseline_kernels();
const Kernels* avx2_kernels();
const Kernels* avx512_kernels();

/// The kernels of simd_level(), chosen once.
const Kernels& kernels();

}  // namespace polhode::summary
