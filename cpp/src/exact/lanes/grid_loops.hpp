#pragma once

#include <numbers>

#include "math/lanes/scalar.hpp"
#include "polhode/exact/detail/time_grid.hpp"
#include "polhode/math/detail/phase.hpp"
#include "polhode/math/detail/sincos.hpp"

// Phases on a uniform grid of times: a rotation by an angle from a table replaces a sine and a cosine.
namespace polhode::POLHODE_ISA {

using exact::TimeGrid;
using math::few_cycles, math::sincos_cycles;

/// The number of times, out of n, in the block that starts at `first`.
POLHODE_INLINE std::size_t in_block(std::size_t n, std::size_t first) {
  return n - first < TimeGrid::block ? n - first : TimeGrid::block;
}

/// Fills rest (n) and the largest of them, both exactly.
POLHODE_INLINE void measure_block(const double* t, std::size_t n, double stride, double* rest, double* largest) {
  Wide worst(0.0), broken(0.0);
  for (std::size_t part = 0; part < TimeGrid::row; part += Wide::width) {
    const Wide start = Wide::load(t + part);
    double behind = 0.0;
    for (std::size_t k = part; k - part + TimeGrid::row <= n; k += TimeGrid::row, behind += stride) {
      const auto since = math::two_diff(Wide::load(t + k), start);
      const Wide left = (since.hi - Wide(behind)) + since.lo;
      worst = larger(worst, abs(left));
      broken = broken + (left - left);  // stays 0 while all is finite
      left.store(rest + k);
    }
  }
  double sizes[Wide::width], breaks[Wide::width], most = 0.0;
  worst.store(sizes), broken.store(breaks);
  for (std::size_t i = 0; i < Wide::width; ++i) {
    most = most < sizes[i] ? sizes[i] : most;
    if (breaks[i] != 0.0) most = std::numeric_limits<double>::infinity();
  }
  *largest = most;
}

inline void measure(const double* t, std::size_t n, double stride, double* rest, double* largest) {
  for (std::size_t first = 0; first < n; first += TimeGrid::block)
    measure_block(t + first, in_block(n, first), stride, rest + first, largest + first / TimeGrid::block);
}

/// The largest |t|; infinity if a time is not finite.
inline double reach(const double* t, std::size_t n) {
  constexpr double most = std::numeric_limits<double>::max(), beyond = std::numeric_limits<double>::infinity();
  double largest = 0.0;
  std::size_t i = 0;
  if (n >= 2 * Wide::width) {
    Wide all(0.0);
    for (; i + Wide::width <= n; i += Wide::width) {
      const Wide size = abs(Wide::load(t + i));
      all = math::max(all, select(size <= Wide(most), size, Wide(beyond)));
    }
    double sizes[Wide::width];
    all.store(sizes);
    for (const double size : sizes) largest = largest < size ? size : largest;
  }
  for (; i < n; ++i) {
    const double size = math::abs(t[i]);
    largest = !(size <= most) ? beyond : largest < size ? size : largest;
  }
  return largest;
}

inline constexpr exact::TimeKernels time_kernels = {.measure = &measure, .reach = &reach};

/// `count` phases, in cycles: rate t' + start with t' = scale t.
template <int count>
struct Rates {
  double scale, hi[count], lo[count], start[count];
};

template <class T>
struct Angle {
  T sine, cosine;
};

/// Sines and cosines of `count` phases for one block of times.
template <int count>
struct Angles {
  alignas(64) double sine[count][TimeGrid::block], cosine[count][TimeGrid::block];

  template <class T>
  POLHODE_INLINE Angle<T> get(int c, std::size_t k) const {
    return {T::load(sine[c] + k), T::load(cosine[c] + k)};
  }
  template <class T>
  POLHODE_INLINE void put(int c, std::size_t k, Angle<T> a) {
    a.sine.store(sine[c] + k), a.cosine.store(cosine[c] + k);
  }
};

template <class T, int count>
POLHODE_INLINE Angle<T> angle_at(const Rates<count>& rates, int c, T t) {
  Angle<T> a;
  sincos_cycles(few_cycles(t * T(rates.scale), T(rates.hi[c]), T(rates.lo[c]), T(rates.start[c])), a.sine, a.cosine);
  return a;
}

/// The phases of one motion on a grid.
template <int count>
class GridPhases {
 public:
  POLHODE_INLINE GridPhases(const Rates<count>& rates, const TimeGrid& grid) : grid_(grid) {
    if (!grid.uniform()) return;
    double steps[TimeGrid::rows];
    for (std::size_t i = 0; i < TimeGrid::rows; ++i) steps[i] = static_cast<double>(i) * grid.stride;
    for (int c = 0; c < count; ++c) {
      slope_[c] = 2.0 * std::numbers::pi * rates.hi[c];
      fastest_ = math::max(fastest_, math::abs(slope_[c]));
      Rates<count> from_zero = rates;
      from_zero.start[c] = 0.0;
      for (std::size_t i = 0; i < TimeGrid::rows; i += Wide::width) {
        const Angle<Wide> a = angle_at<Wide>(from_zero, c, Wide::load(steps + i));
        a.sine.store(sine_[c] + i), a.cosine.store(cosine_[c] + i);
      }
    }
  }

  /// Fills the first n / 8 rows of the block that starts at `first`. Returns false if that is not accurate enough.
  POLHODE_INLINE bool fill(const Rates<count>& rates, std::size_t first, std::size_t n, Angles<count>& angles) {
    alignas(64) double own_rest[TimeGrid::block], own_largest;
    if (!grid_.uniform()) return false;
    if (!grid_.rest) measure_block(grid_.t + first, n, grid_.stride, own_rest, &own_largest);
    const double* rest = grid_.rest ? grid_.rest + first : own_rest;
    const double largest = grid_.rest ? grid_.largest[first / TimeGrid::block] : own_largest;
    // The correction is of first order: the square of the remaining angle must be below rounding.
    if (!(largest * rates.scale * fastest_ <= 1e-8)) return false;
    for (int c = 0; c < count; ++c) {
      for (std::size_t part = 0; part < TimeGrid::row; part += Wide::width) {
        const Angle<Wide> a = angle_at(rates, c, Wide::load(grid_.t + first + part));
        for (std::size_t i = 0; i < n / TimeGrid::row; ++i) {
          const std::size_t k = TimeGrid::row * i + part;
          const Wide S(sine_[c][i]), C(cosine_[c][i]);
          const Wide more = Wide::load(rest + k) * Wide(rates.scale) * Wide(slope_[c]);
          const Wide s = madd(a.sine, C, a.cosine * S), co = madd(a.cosine, C, -(a.sine * S));
          angles.put(c, k, Angle<Wide>{madd(more, co, s), madd(-more, s, co)});
        }
      }
    }
    return true;
  }

 private:
  const TimeGrid& grid_;
  double slope_[count], fastest_ = 0.0;
  double sine_[count][TimeGrid::rows], cosine_[count][TimeGrid::rows];
};

/// Calls prepare(angles, kept) and finish(angles, kept, k) at every time, with the angles of the phases at that time,
/// for one lane or a vector of lanes. `kept` numbers are passed from one to the other. Each block has three short
/// loops: the phases, the part that ends in a root and a division, and the rest. The processor overlaps the rounds of
/// short loops.
template <int kept, int count, class Prepare, class Finish>
POLHODE_INLINE void at_phases(const Rates<count>& rates, const TimeGrid& grid, const Prepare& prepare,
                              const Finish& finish) {
  GridPhases<count> phases(rates, grid);
  Angles<count> angles;
  alignas(64) double middle[kept][TimeGrid::block];
  for (std::size_t first = 0; first < grid.n; first += TimeGrid::block) {
    const std::size_t n = in_block(grid.n, first);
    const std::size_t whole = n / Wide::width * Wide::width, rows = n / TimeGrid::row * TimeGrid::row;
    const std::size_t filled = phases.fill(rates, first, n, angles) ? rows : 0;
    for (int c = 0; c < count; ++c)
      for (std::size_t k = filled; k < whole; k += Wide::width)
        angles.put(c, k, angle_at(rates, c, Wide::load(grid.t + first + k)));
    for (std::size_t k = 0; k < whole; k += Wide::width) {
      Angle<Wide> now[count];
      Wide found[kept];
      for (int c = 0; c < count; ++c) now[c] = angles.template get<Wide>(c, k);
      prepare(now, found);
      for (int i = 0; i < kept; ++i) found[i].store(middle[i] + k);
    }
    for (std::size_t k = 0; k < whole; k += Wide::width) {
      Angle<Wide> now[count];
      Wide found[kept];
      for (int c = 0; c < count; ++c) now[c] = angles.template get<Wide>(c, k);
      for (int i = 0; i < kept; ++i) found[i] = Wide::load(middle[i] + k);
      finish(now, found, first + k);
    }
    for (std::size_t k = whole; k < n; ++k) {
      Angle<One> now[count];
      for (int c = 0; c < count; ++c) now[c] = angle_at(rates, c, One::load(grid.t + first + k));
      One found[kept];
      prepare(now, found);
      finish(now, found, first + k);
    }
  }
}

}  // namespace polhode::POLHODE_ISA
