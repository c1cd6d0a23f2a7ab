#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "exact/time_parts.hpp"
#include "polhode/core/interrupt.hpp"
#include "polhode/exact/detail/time_grid.hpp"

namespace polhode {

/// Whether every |value| <= most. False for NaN and, with the default, for infinity.
inline bool within(const double* values, std::size_t n, double most = std::numeric_limits<double>::max()) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i) count += std::abs(values[i]) <= most;
  return count == n;
}

/// "inertia[12]", for messages.
inline std::string row_name(const char* what, std::size_t body) {
  return std::string(what) + "[" + std::to_string(body) + "]";
}

/// Times that all bodies share, analysed once.
class SharedTimes {
 public:
  /// With `keep`, the offsets of a grid are stored for all bodies; without, each evaluation computes them.
  SharedTimes(const exact::TimeKernels& kernels, const double* t, std::size_t n, bool keep)
      : grid(t, n), reach(kernels.reach(t, n)) {
    if (!std::isfinite(reach)) grid = any_times(t, n);
    if (!keep || !grid.uniform()) return;
    rest_.resize(n), largest_.resize((n - 1) / exact::TimeGrid::block + 1);
    kernels.measure(t, n, grid.stride, rest_.data(), largest_.data());
    grid.rest = rest_.data(), grid.largest = largest_.data();
  }
  SharedTimes(const SharedTimes&) = delete;
  SharedTimes& operator=(const SharedTimes&) = delete;

  static exact::TimeGrid any_times(const double* t, std::size_t n) {
    exact::TimeGrid times;
    times.t = t, times.n = n;
    return times;
  }

  exact::TimeGrid grid;
  double reach;  ///< the largest |t|; infinity if a time is not finite

 private:
  std::vector<double> rest_, largest_;
};

/// The output rows of a batch: omega (bodies, times, 3) and attitude (bodies, times, 4); either may be null.
struct Rows {
  const double* t;
  std::size_t times;
  const exact::TimeGrid* shared;  ///< the times of all bodies; null where each has its own
  bool finite;                    ///< whether the shared times are
  double *omega, *attitude;

  const double* times_of(std::size_t body) const { return t + (shared ? 0 : body * times); }
  double* omega_of(std::size_t body, std::size_t i = 0) const {
    return omega ? omega + 3 * (body * times + i) : nullptr;
  }
  double* attitude_of(std::size_t body, std::size_t i = 0) const {
    return attitude ? attitude + 4 * (body * times + i) : nullptr;
  }

  std::size_t poison(std::size_t body, std::size_t from, std::size_t count) const {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    if (omega) std::fill_n(omega_of(body, from), 3 * count, nan);
    if (attitude) std::fill_n(attitude_of(body, from), 4 * count, nan);
    return count;
  }

  /// Calls evaluate(times, omega, attitude) for each run of finite times. Poisons the other rows and returns their
  /// number. Times that are not all finite are never taken as a grid: bits must not depend on how threads divide them.
  template <class Evaluate>
  std::size_t each_run(std::size_t body, const Evaluate& evaluate) const {
    const double* own = times_of(body);
    if (finite || within(own, times)) {
      exact::each_part(shared ? *shared : exact::TimeGrid(own, times),
                       [&](const exact::TimeGrid& part, std::size_t begin) {
                         evaluate(part, omega_of(body, begin), attitude_of(body, begin));
                       });
      return 0;
    }
    std::size_t poisoned = 0;
    for (std::size_t i = 0, end = 0; i < times; i = end) {
      const bool good = std::isfinite(own[i]);
      for (end = i; end < times && std::isfinite(own[end]) == good;) ++end;
      if (good) {
        evaluate(SharedTimes::any_times(own + i, end - i), omega_of(body, i), attitude_of(body, i));
      } else {
        poisoned += poison(body, i, end - i);
      }
    }
    return poisoned;
  }
};

}  // namespace polhode
