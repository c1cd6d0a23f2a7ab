#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "polhode/math/detail/functions.hpp"

namespace polhode {

/// The samples, or null where there are none.
inline const double* get_data(const std::vector<double>& samples) { return samples.empty() ? nullptr : samples.data(); }

/// The distance of two motions at n samples, as `accuracy` is defined. It is the larger of two: |omega - omega'|
/// relative to the largest |omega| of the start and the samples, and the angle between the attitudes [rad]. Either pair
/// may be null. NaN gives NaN.
/// @param start_rate  |omega| at the start
inline double compute_distance(std::size_t n, double start_rate, const double* omega_a, const double* attitude_a,
                               const double* omega_b, const double* attitude_b) {
  double size = 0.0, rate_square = 0.0, attitude_square = 0.0;
  const auto keep = [](double& largest, double value) {
    largest = largest != largest || value <= largest ? largest : value;
  };
  for (std::size_t i = 0; omega_a != nullptr && i < n; ++i) {
    double s = 0.0, d = 0.0;
    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
      s += omega_a[k] * omega_a[k];
      d += (omega_a[k] - omega_b[k]) * (omega_a[k] - omega_b[k]);
    }
    size = std::max(size, s);
    keep(rate_square, d);
  }
  for (std::size_t i = 0; attitude_a != nullptr && i < n; ++i) {
    double near = 0.0, far = 0.0;
    for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) {
      near += (attitude_a[k] - attitude_b[k]) * (attitude_a[k] - attitude_b[k]);
      far += (attitude_a[k] + attitude_b[k]) * (attitude_a[k] + attitude_b[k]);
    }
    keep(attitude_square, std::isnan(near) ? near : std::min(near, far));
  }
  const double rates = rate_square == 0.0 ? 0.0 : std::sqrt(rate_square) / std::max(std::sqrt(size), start_rate);
  const double angle = attitude_square != attitude_square
                           ? attitude_square
                           : 4 * math::asin(std::min(1.0, std::sqrt(attitude_square) / 2));
  return rates > angle || rates != rates ? rates : angle;
}

/// The time from the start to the last sample before two motions are farther apart than `most` [s]. It is infinite if
/// they never are, and 0 if they are at the first sample.
inline double find_divergence_time(std::size_t n, const double* t, double t0, double start_rate, const double* omega_a,
                                   const double* attitude_a, const double* omega_b, const double* attitude_b,
                                   double most) {
  double size = start_rate, divergence = HUGE_VAL;
  for (std::size_t i = 0; omega_a != nullptr && i < n; ++i) {
    size = std::max(size, math::hypot(omega_a[3 * i], omega_a[3 * i + 1], omega_a[3 * i + 2]));
  }
  for (std::size_t i = 0; i < n; ++i) {
    double rate_error = 0.0;
    for (std::size_t k = 3 * i; omega_a != nullptr && k < 3 * i + 3; ++k)
      rate_error = math::hypot(rate_error, omega_a[k] - omega_b[k]);
    const double* qa = attitude_a == nullptr ? nullptr : attitude_a + 4 * i;
    const double* qb = attitude_b == nullptr ? nullptr : attitude_b + 4 * i;
    const double attitude_error = qa == nullptr ? 0.0 : compute_distance(1, 0.0, nullptr, qa, nullptr, qb);
    if (!(rate_error <= most * size && attitude_error <= most)) divergence = std::min(divergence, std::abs(t[i] - t0));
  }
  if (divergence == HUGE_VAL) return divergence;
  double together = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double away = std::abs(t[i] - t0);
    if (away < divergence) together = std::max(together, away);
  }
  return together;
}

}  // namespace polhode
