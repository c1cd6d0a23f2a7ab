#pragma once

#include <limits>

#include "batch/summary/kernels.hpp"
#include "batch/summary/lanes/store_bits.hpp"
#include "polhode/math/detail/atan2.hpp"

// Numbers from states, and their sums over bodies, for one lane type `Wide`; a lane is a time. Each file that is built
// for one instruction set includes this once.
namespace polhode::POLHODE_ISA {

using summary::ScalarSums, summary::TimeVectors;

template <int count>
POLHODE_INLINE void load_planes(TimeVectors v, std::size_t k, Wide (&parts)[count]) {
  for (int c = 0; c < count; ++c) parts[c] = Wide::load(v.planes + static_cast<std::size_t>(c) * v.stride + k * v.step);
}

/// conj(n) q.
POLHODE_INLINE void relative(const Wide (&n)[4], const Wide (&q)[4], Wide (&d)[4]) {
  d[0] = madd(n[3], q[0], madd(-n[0], q[3], madd(n[2], q[1], -(n[1] * q[2]))));
  d[1] = madd(n[3], q[1], madd(-n[1], q[3], madd(n[0], q[2], -(n[2] * q[0]))));
  d[2] = madd(n[3], q[2], madd(-n[2], q[3], madd(n[1], q[0], -(n[0] * q[1]))));
  d[3] = madd(n[3], q[3], madd(n[0], q[0], madd(n[1], q[1], n[2] * q[2])));
}

POLHODE_INLINE Wide length(Wide x, Wide y, Wide z) { return sqrt(madd(x, x, madd(y, y, z * z))); }

inline void angle(const double* attitude, TimeVectors nominal, std::size_t n, double* values) {
  for (std::size_t k = 0; k < n; k += Wide::width) {
    Wide q[4], reference[4], d[4];
    load4(attitude + 4 * k, q[0], q[1], q[2], q[3]);
    load_planes(nominal, k, reference);
    relative(reference, q, d);
    // Half of the angle, from sine and cosine: exact for small and for half turns.
    (Wide(12.566370614359172) * math::atan2_cycles(length(d[0], d[1], d[2]), abs(d[3]))).store(values + k);
  }
}

inline void axis_angle(const double* attitude, const double* axis, TimeVectors target, std::size_t n, double* values) {
  const Wide a[3] = {Wide(axis[0]), Wide(axis[1]), Wide(axis[2])};
  for (std::size_t k = 0; k < n; k += Wide::width) {
    Wide q[4], d[3], t[3], u[3];
    load4(attitude + 4 * k, q[0], q[1], q[2], q[3]);
    load_planes(target, k, d);
    // R a = a + w t + v x t, t = 2 v x a.
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, m = (i + 2) % 3;
      const Wide cross = madd(q[j], a[m], -(q[m] * a[j]));
      t[i] = cross + cross;
    }
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, m = (i + 2) % 3;
      u[i] = a[i] + madd(q[3], t[i], madd(q[j], t[m], -(q[m] * t[j])));
    }
    const Wide across = length(madd(u[1], d[2], -(u[2] * d[1])), madd(u[2], d[0], -(u[0] * d[2])),
                               madd(u[0], d[1], -(u[1] * d[0])));
    const Wide along = madd(u[0], d[0], madd(u[1], d[1], u[2] * d[2]));
    (Wide(6.283185307179586) * math::atan2_cycles(across, along)).store(values + k);
  }
}

inline void rate(const double* omega, std::size_t n, double* values) {
  for (std::size_t k = 0; k < n; k += Wide::width) {
    Wide x, y, z;
    load3(omega + 3 * k, x, y, z);
    length(x, y, z).store(values + k);
  }
}

inline void energy(const double* omega, const double* tensor, std::size_t n, double* values) {
  Wide I[6];
  for (int i = 0; i < 6; ++i) I[i] = Wide(i < 3 ? 0.5 * tensor[i] : tensor[i]);
  for (std::size_t k = 0; k < n; k += Wide::width) {
    Wide x, y, z;
    load3(omega + 3 * k, x, y, z);
    const Wide by_x = madd(I[0], x, madd(I[3], y, I[4] * z)), by_y = madd(I[1], y, I[5] * z);
    madd(by_x, x, madd(by_y, y, I[2] * z * z)).store(values + k);
  }
}

inline void deviation(const double* attitude, TimeVectors nominal, std::size_t n, double* planes, std::size_t stride) {
  for (std::size_t k = 0; k < n; k += Wide::width) {
    Wide q[4], reference[4], d[4];
    load4(attitude + 4 * k, q[0], q[1], q[2], q[3]);
    load_planes(nominal, k, reference);
    relative(reference, q, d);
    for (std::size_t c = 0; c < 4; ++c) d[c].store(planes + c * stride + k);
  }
}

/// The bins of a vector of times, body by body, one row a time.
template <bool both_signs>
POLHODE_INLINE void count_bins(const std::int64_t (&bits)[summary::tile][Wide::width], std::size_t bodies,
                               std::size_t times, const ScalarSums& s) {
  constexpr std::int64_t sign = std::int64_t{1} << 17;
  const std::int64_t below = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(s.first) >> 46) - 1;
  const std::int64_t middle = both_signs ? static_cast<std::int64_t>(s.row) / 2 - 1 : 0;
  for (std::size_t b = 0; b < bodies; ++b) {
    for (std::size_t j = 0; j < times; ++j) {
      const std::int64_t size = (bits[b][j] & ~sign) - below;
      const std::int64_t at = both_signs && (bits[b][j] & sign) != 0 ? middle - size : middle + size;
      ++s.bins[j * s.row + static_cast<std::size_t>(at)];
    }
  }
}

template <bool both_signs>
POLHODE_INLINE void add_scalar(const double* values, std::size_t bodies, std::size_t times, const ScalarSums& sums) {
  constexpr double most = std::numeric_limits<double>::max();
  const std::int64_t below = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(sums.first) >> 46) - 1;
  const auto row_length = static_cast<std::int64_t>(sums.row);
  const std::int64_t beyond = both_signs ? row_length / 2 : row_length - 1;
  // Numbers out of range become the nearest one of the bins at the ends; NaN, one beyond all bins.
  const Wide low(std::bit_cast<double>(static_cast<std::uint64_t>(below) << 46)), high(sums.last);
  const Wide trash(std::bit_cast<double>(static_cast<std::uint64_t>(below + beyond) << 46));
  alignas(64) std::int64_t bits[summary::tile][Wide::width];
  for (std::size_t k = 0; k < times; k += Wide::width) {
    Wide count = Wide::load(sums.count + k), sum = Wide::load(sums.sum + k), sum2 = Wide::load(sums.sum2 + k);
    Wide least = Wide::load(sums.least + k), largest = Wide::load(sums.largest + k);
    for (std::size_t b = 0; b < bodies; ++b) {
      const Wide v = Wide::load(values + b * summary::span + k), size = abs(v);
      const auto good = size <= Wide(most);
      count = count + select(good, Wide(1.0), Wide(0.0));
      sum = sum + select(good, v, Wide(0.0));
      sum2 = select(good, madd(v, v, sum2), sum2);
      least = select(good & (v < least), v, least);
      largest = select(good & (v > largest), v, largest);
      const Wide held = math::max(low, math::min(high, size));
      const Wide shown = both_signs ? copysign(held, v) : held;
      store_bits(bits[b], select(good, shown, trash));
    }
    count.store(sums.count + k), sum.store(sums.sum + k), sum2.store(sums.sum2 + k);
    least.store(sums.least + k), largest.store(sums.largest + k);
    ScalarSums row = sums;
    row.bins = sums.bins + k * sums.row;
    const std::size_t left = times - k;
    count_bins<both_signs>(bits, bodies, left < Wide::width ? left : Wide::width, row);
  }
}

inline void add(const double* values, std::size_t bodies, std::size_t times, ScalarSums sums) {
  if (sums.both_signs) return add_scalar<true>(values, bodies, times, sums);
  add_scalar<false>(values, bodies, times, sums);
}

inline void add_products(const double* planes, std::size_t bodies, std::size_t times, double* counts, double* products,
                         std::size_t plane) {
  for (std::size_t k = 0; k < times; k += Wide::width) {
    Wide count = Wide::load(counts + k), sum[10];
    for (std::size_t i = 0; i < 10; ++i) sum[i] = Wide::load(products + i * plane + k);
    for (std::size_t b = 0; b < bodies; ++b) {
      Wide q[4];
      for (std::size_t c = 0; c < 4; ++c) q[c] = Wide::load(planes + (4 * b + c) * summary::span + k);
      const auto good = abs(q[3]) <= Wide(std::numeric_limits<double>::max());
      count = count + select(good, Wide(1.0), Wide(0.0));
      for (Wide& part : q) part = select(good, part, Wide(0.0));
      for (int c = 0, i = 0; c < 4; ++c)
        for (int d = c; d < 4; ++d, ++i) sum[i] = madd(q[c], q[d], sum[i]);
    }
    count.store(counts + k);
    for (std::size_t i = 0; i < 10; ++i) sum[i].store(products + i * plane + k);
  }
}

inline constexpr summary::Kernels summary_kernels = {.angle = &angle,
                                                     .axis_angle = &axis_angle,
                                                     .rate = &rate,
                                                     .energy = &energy,
                                                     .deviation = &deviation,
                                                     .add = &add,
                                                     .add_products = &add_products};

}  // namespace polhode::POLHODE_ISA
