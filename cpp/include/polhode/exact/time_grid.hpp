#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace polhode::exact {

/// Times as the loops read them: in blocks of 16 rows of 8, at fixed places. The first row of a block is evaluated as
/// any times are; the others lie whole strides of eight steps behind it, so that their phases are those of the first
/// row turned by angles from a small table, plus, to first order, what rounding of the times left over. Whether that
/// is exact enough is decided block by block from the leftovers themselves; where it is not, times are any times.
struct TimeGrid {
  static constexpr std::size_t row = 8, rows = 16, block = row * rows;
  static constexpr std::size_t fewest = 64;  ///< below it the table does not pay

  const double* t = nullptr;
  std::size_t n = 0;
  double stride = std::numeric_limits<double>::quiet_NaN();  ///< eight steps; NaN: not a grid
  const double* rest = nullptr;     ///< (n) what t is beyond its block's first row and whole strides; null: not known
  const double* largest = nullptr;  ///< of each block the largest |rest|

  TimeGrid() = default;
  /// The whole of one body's times: the mean step is theirs.
  TimeGrid(const double* times, std::size_t count) : t(times), n(count) {
    if (count < fewest) return;
    const double mean = (times[count - 1] - times[0]) / static_cast<double>(count - 1) * static_cast<double>(row);
    // Four bits fewer, so that 15 strides are exact.
    stride = std::bit_cast<double>(std::bit_cast<std::uint64_t>(mean) & ~std::uint64_t{15});
    if (!(std::abs(stride) < 1e300)) stride = std::numeric_limits<double>::quiet_NaN();
  }

  bool uniform() const { return stride == stride; }

  /// A piece of the same grid; `first` at the start of a block.
  TimeGrid piece(std::size_t first, std::size_t count) const {
    TimeGrid part = *this;
    part.t += first, part.n = count;
    if (rest) part.rest += first, part.largest += first / block;
    return part;
  }
};

/// What is compiled for one instruction set.
struct TimeKernels {
  /// Fills rest (n) and largest (one a block); both are exact.
  void (*measure)(const double* t, std::size_t n, double stride, double* rest, double* largest);
  /// The largest |t|; infinity where one is not finite.
  double (*reach)(const double* t, std::size_t n);
};

}  // namespace polhode::exact
