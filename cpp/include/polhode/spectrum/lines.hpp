#pragma once

#include <cstddef>
#include <span>

namespace polhode::spectrum {

/// Trial frequencies first + step k [rad/s], k < count.
struct Grid {
  double first = 0.0, step = 0.0;
  std::size_t count = 1;
};

/// The frequency a f + b g of a spectrum whose lines are sums of two frequencies f and g; (0, 0) is the constant.
struct Line {
  int a = 0, b = 0;
};

/// Samples of some real series at any times.
struct Series {
  std::span<const double> t;        ///< (n) [s]
  std::span<const double> y;        ///< (n, count), row by row, times the weight of the row
  std::span<const double> weight;   ///< (n), or empty for one each: the cosines and sines are multiplied by it too
  std::size_t count = 1;            ///< series
};

/// Y^T P Y for each pair of trial frequencies: P projects on cosines and sines of the lines at the sample times.
///
/// The trace of it is the sum of squares that the best sum of these lines takes away (Lomb 1976, for one line).
/// A line whose columns are sums of the others, as at frequency 0, adds nothing.
/// @param block  the series are taken in blocks of so many, and the products of one block alone are formed
/// @param out    (f.count, g.count, count / block, block, block)
/// @throws InvalidInput unless the sizes agree
void project(const Series& series, std::span<const Line> lines, const Grid& f, const Grid& g, std::size_t block,
             double* out);

/// The sum over complex series of |sum_k exp(-i f t_k) z_k|^2 for each trial frequency f.
/// @param z    (n, count, 2), row by row: real and imaginary parts
/// @param out  (f.count)
/// @throws InvalidInput unless the sizes agree
void periodogram(std::span<const double> t, std::span<const double> z, std::size_t count, const Grid& f, double* out);

}  // namespace polhode::spectrum
