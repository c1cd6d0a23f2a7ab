#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "exact/time_parts.hpp"
#include "polhode/batch/output.hpp"
#include "polhode/core/interrupt.hpp"
#include "polhode/exact/detail/free_kernels.hpp"
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

/// The output rows of a batch.
struct Rows {
  const double* t;
  std::size_t times;
  const exact::TimeGrid* shared;  ///< the times of all bodies; null where each has its own
  bool finite;                    ///< whether the shared times are
  MotionOutput out;

  const double* times_of(std::size_t body) const { return t + (shared ? 0 : body * times); }

  std::size_t fail(std::size_t body, std::size_t from, std::size_t count) const {
    const MotionOutput at = out.from(body * times + from);
    fail(at.rows, count), fail(at.single, count);
    return count;
  }

  /// Calls evaluate(times, omega, attitude) for each run of finite times. Fills the other rows with NaN and returns their
  /// number. Times that are not all finite are never taken as a grid: bits must not depend on how threads divide them.
  /// single(times, omega, attitude), if there is one, writes floats.
  template <class Evaluate, class Single = std::nullptr_t>
  std::size_t each_run(std::size_t body, const Evaluate& evaluate, const Single& single = nullptr) const {
    if (!follows(body)) return fail(body, 0, times);
    const double* own = times_of(body);
    if (finite || within(own, times)) {
      exact::each_part(shared ? *shared : exact::TimeGrid(own, times),
                       [&](const exact::TimeGrid& part, std::size_t i) { run(body, i, part, evaluate, single); });
      return 0;
    }
    std::size_t failed = 0;
    for (std::size_t i = 0, end = 0; i < times; i = end) {
      const bool good = std::isfinite(own[i]);
      for (end = i; end < times && std::isfinite(own[end]) == good;) ++end;
      if (good) {
        run(body, i, SharedTimes::any_times(own + i, end - i), evaluate, single);
      } else {
        failed += fail(body, i, end - i);
      }
    }
    return failed;
  }

  /// Bodies at one time each: calls evaluate(omega, attitude) for n of them at once.
  template <class Evaluate>
  void once(std::size_t first, std::size_t n, const Evaluate& evaluate) const {
    const MotionOutput at = out.from(first);
    if (out.plain()) return evaluate(at.rows.omega, at.rows.attitude);
    std::vector<double> omega(3 * n), attitude(4 * n);
    evaluate(omega.data(), attitude.data());
    for (std::size_t i = 0; i < n; ++i) write(first + i, first + i, 1, &omega[3 * i], &attitude[4 * i]);
  }
  /// Fills with NaN what `once` could not know; returns its number.
  std::size_t after_once(std::size_t body) const {
    return follows(body) && std::isfinite(*times_of(body)) ? 0 : fail(body, 0, 1);
  }

 private:
  template <class S>
  static void fail(const MotionRows<S>& rows, std::size_t count) {
    const S nan = std::numeric_limits<S>::quiet_NaN();
    if (rows.omega) std::fill_n(rows.omega, 3 * count, nan);
    if (rows.attitude) std::fill_n(rows.attitude, 4 * count, nan);
    if (rows.direction) std::fill_n(rows.direction, 3 * count, nan);
  }

  /// Whether the body's vector can be rotated.
  bool follows(std::size_t body) const { return !out.has_direction() || within(out.vector + 3 * body, 3, 1e300); }

  template <class Evaluate, class Single>
  void run(std::size_t body, std::size_t begin, const exact::TimeGrid& part, const Evaluate& evaluate,
           const Single& single) const {
    const MotionOutput at = out.from(body * times + begin);
    if (out.plain()) return evaluate(part, at.rows.omega, at.rows.attitude);
    if constexpr (!std::is_same_v<Single, std::nullptr_t>) {
      if (out.single_states()) return single(part, at.single.omega, at.single.attitude);
    }
    // By way of as many doubles as a cache holds, which whole blocks of the grid fill.
    constexpr std::size_t most = 4 * exact::TimeGrid::block;
    double omega[3 * most], attitude[4 * most];
    const bool rates = at.rows.omega || at.single.omega;
    const bool attitudes = at.rows.attitude || at.single.attitude || out.has_direction();
    for (std::size_t i = 0; i < part.n; i += most) {
      const std::size_t n = std::min(most, part.n - i);
      evaluate(part.piece(i, n), rates ? omega : nullptr, attitudes ? attitude : nullptr);
      write(body, body * times + begin + i, n, omega, attitude);
    }
  }

  /// Writes n states of a body to the outputs from a row on.
  void write(std::size_t body, std::size_t row, std::size_t n, const double* omega, const double* attitude) const {
    const exact::FreeBatchKernels& kernels = exact::free_batch_kernels();
    const MotionOutput at = out.from(row);
    if (at.rows.omega) std::copy_n(omega, 3 * n, at.rows.omega);
    if (at.rows.attitude) std::copy_n(attitude, 4 * n, at.rows.attitude);
    if (at.single.omega) kernels.narrow(omega, 3 * n, at.single.omega);
    if (at.single.attitude) kernels.narrow(attitude, 4 * n, at.single.attitude);
    if (at.rows.direction) kernels.rotate(out.vector + 3 * body, attitude, n, out.from_space, at.rows.direction);
    if (at.single.direction) {
      std::vector<double> rotated(3 * n);
      kernels.rotate(out.vector + 3 * body, attitude, n, out.from_space, rotated.data());
      kernels.narrow(rotated.data(), 3 * n, at.single.direction);
    }
  }
};

}  // namespace polhode
