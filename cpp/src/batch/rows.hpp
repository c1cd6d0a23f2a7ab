#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>

namespace polhode {

/// Every |value| <= most: no for NaN and, at the default, for infinity.
inline bool within(const double* values, std::size_t n, double most = std::numeric_limits<double>::max()) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i) count += std::abs(values[i]) <= most;
  return count == n;
}

/// "inertia[12]", for messages.
inline std::string row_name(const char* what, std::size_t body) {
  return std::string(what) + "[" + std::to_string(body) + "]";
}

/// Where the results of a batch go: omega (bodies, times, 3) and attitude (bodies, times, 4); either may be null.
struct Rows {
  const double* t;
  std::size_t times;
  bool own_times;
  double *omega, *attitude;

  const double* times_of(std::size_t body) const { return t + (own_times ? body * times : 0); }
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

  /// evaluate(t, count, omega, attitude) for each run of finite times; the rows between are poisoned and counted.
  template <class Evaluate>
  std::size_t each_run(std::size_t body, const Evaluate& evaluate) const {
    const double* own = times_of(body);
    if (within(own, times)) {
      evaluate(own, times, omega_of(body), attitude_of(body));
      return 0;
    }
    std::size_t poisoned = 0;
    for (std::size_t i = 0, end = 0; i < times; i = end) {
      const bool good = std::isfinite(own[i]);
      for (end = i; end < times && std::isfinite(own[end]) == good;) ++end;
      if (good) {
        evaluate(own + i, end - i, omega_of(body, i), attitude_of(body, i));
      } else {
        poisoned += poison(body, i, end - i);
      }
    }
    return poisoned;
  }
};

}  // namespace polhode
