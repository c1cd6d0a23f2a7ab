#pragma once

#include <algorithm>
#include <cstddef>

namespace polhode {

/// Whether all of many values are finite. A number times 0 is 0, or NaN if it is not finite: sums without branches,
/// sixteen side by side.
inline bool all_finite(const double* values, std::size_t n) {
  constexpr std::size_t width = 16;
  double sums[width] = {};
  std::size_t i = 0;
  for (; i + width <= n; i += width)
    for (std::size_t k = 0; k < width; ++k) sums[k] += 0.0 * values[i + k];
  for (; i < n; ++i) sums[0] += 0.0 * values[i];
  return std::all_of(sums, sums + width, [](double sum) { return sum == 0.0; });
}

}  // namespace polhode
