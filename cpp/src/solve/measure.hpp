#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace polhode {

/// The distance of two motions at n samples, as the accuracy is meant: the larger of |omega - omega'| relative to the
/// largest |omega|, and the angle between the attitudes [rad]. Either pair may be null. A NaN comes through.
inline double compute_distance(std::size_t n, const double* omega_a, const double* attitude_a, const double* omega_b,
                               const double* attitude_b) {
  double size = 0.0, moved = 0.0, turned = 0.0;
  const auto keep = [](double& largest, double value) { largest = largest != largest || value <= largest ? largest : value; };
  for (std::size_t i = 0; omega_a != nullptr && i < n; ++i) {
    double s = 0.0, d = 0.0;
    for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
      s += omega_a[k] * omega_a[k];
      d += (omega_a[k] - omega_b[k]) * (omega_a[k] - omega_b[k]);
    }
    size = std::max(size, s);
    keep(moved, d);
  }
  for (std::size_t i = 0; attitude_a != nullptr && i < n; ++i) {
    double near = 0.0, far = 0.0;
    for (std::size_t k = 4 * i; k < 4 * i + 4; ++k) {
      near += (attitude_a[k] - attitude_b[k]) * (attitude_a[k] - attitude_b[k]);
      far += (attitude_a[k] + attitude_b[k]) * (attitude_a[k] + attitude_b[k]);
    }
    keep(turned, std::isnan(near) ? near : std::min(near, far));
  }
  const double rates = moved == 0.0 ? 0.0 : std::sqrt(moved / size);
  const double angle = turned != turned ? turned : 4 * std::asin(std::min(1.0, std::sqrt(turned) / 2));
  return rates > angle || rates != rates ? rates : angle;
}

}  // namespace polhode
