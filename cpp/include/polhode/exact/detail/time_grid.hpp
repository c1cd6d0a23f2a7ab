#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace polhode::exact {

/// Times in blocks of 16 rows of 8, at fixed places. The phases of the first row of a block are evaluated directly. On
/// a uniform grid the other rows lie whole strides of eight steps behind it. Their phases are those of the first row
/// rotated by angles from a small table, plus a first-order correction for the rounding of the times. If the correction
/// is too large in a block, its phases are all evaluated directly.
struct TimeGrid {
  static constexpr std::size_t row = 8, rows = 16, block = row * rows;
  static constexpr std::size_t fewest = 64;  ///< with fewer times the table does not pay

  const double* t = nullptr;
  std::size_t n = 0;
  double stride = std::numeric_limits<double>::quiet_NaN();  ///< eight steps; NaN: not a grid
  const double* rest = nullptr;     ///< (n) t minus the time in the first row and whole strides; null: not computed
  const double* largest = nullptr;  ///< of each block the largest |rest|

  TimeGrid() = default;
  /// All times of one body; the stride follows from their mean step.
  TimeGrid(const double* times, std::size_t count) : t(times), n(count) {
    if (count < fewest) return;
    const double mean = (times[count - 1] - times[0]) / static_cast<double>(count - 1) * static_cast<double>(row);
    // The last four bits are cleared, so that 15 strides are exact.
    stride = std::bit_cast<double>(std::bit_cast<std::uint64_t>(mean) & ~std::uint64_t{15});
    if (!(std::abs(stride) < 1e300)) stride = std::numeric_limits<double>::quiet_NaN();
  }

  bool uniform() const { return stride == stride; }

  /// A part of the same grid; `first` must be the start of a block.
  TimeGrid piece(std::size_t first, std::size_t count) const {
    TimeGrid part = *this;
    part.t += first, part.n = count;
    if (rest) part.rest += first, part.largest += first / block;
    return part;
  }
};

/// Loops over times, compiled for one instruction set.
struct TimeKernels {
  /// Fills rest (n) and largest (one a block), both exactly.
  void (*measure)(const double* t, std::size_t n, double stride, double* rest, double* largest);
  /// The largest |t|; infinity if a time is not finite.
  double (*reach)(const double* t, std::size_t n);
};

}  // namespace polhode::exact
