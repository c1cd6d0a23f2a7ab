#include "orbit/kepler_series.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace polhode::kepler {
namespace {

constexpr std::size_t most_rows = 64;
using Row = std::array<double, most_rows>;

/// sum of a_j b_{n-j}
double convolve(const Row& a, const Row& b, std::size_t n) {
  double sum = 0.0;
  for (std::size_t j = 0; j <= n; ++j) sum += a[j] * b[n - j];
  return sum;
}

/// Rotates (a, b) by an angle that grows from 0 at a rate, given by the unit of time.
void rotate(Row& a, Row& b, double rate, std::size_t end) {
  if (rate == 0.0) return;
  Row c{}, s{}, x = a, y = b;
  double term = 1.0;
  for (std::size_t n = 0; n < end; ++n) {
    if (n > 0) term *= rate / static_cast<double>(n);
    (n % 2 == 0 ? c : s)[n] = n % 4 < 2 ? term : -term;
  }
  for (std::size_t n = 0; n < end; ++n) {
    a[n] = convolve(x, c, n) - convolve(y, s, n);
    b[n] = convolve(x, s, n) + convolve(y, c, n);
  }
}

}  // namespace

void expand(double mu, const PlaneState& start, const MovingPlane& plane, double unit, int order, double* rows) {
  const double distance = std::sqrt(start.x * start.x + start.y * start.y), pull = mu / distance * (unit / distance) * (unit / distance);
  const auto end = static_cast<std::size_t>(order) + 1;
  Row x, y, s, u, inverse;
  x[0] = start.x / distance, y[0] = start.y / distance;
  x[1] = unit / distance * start.vx, y[1] = unit / distance * start.vy;
  for (std::size_t n = 0; n < end; ++n) {
    const auto k = static_cast<double>(n);
    // Sums side by side, which wait for no other: s_n, then u_n, then what needs both.
    double along = 0.0, across = 0.0, power = 0.0;
    for (std::size_t j = 0; j <= n; ++j) along += x[j] * x[n - j], across += y[j] * y[n - j];
    s[n] = n == 0 ? 1.0 : along + across;
    for (std::size_t j = 1; j <= n; ++j) power -= (k + 0.5 * static_cast<double>(j)) * s[j] * u[n - j];
    u[n] = n == 0 ? 1.0 : power / k;
    double low = u[n], length = 0.0, pull_x = x[0] * u[n], pull_y = y[0] * u[n];
    for (std::size_t j = 1; j <= n; ++j) {
      low += s[j] * u[n - j], length += s[j] * inverse[n - j];
      pull_x += x[j] * u[n - j], pull_y += y[j] * u[n - j];
    }
    inverse[n] = low, length += low;
    const double factor = -pull / ((k + 1.0) * (k + 2.0));
    x[n + 2] = factor * pull_x, y[n + 2] = factor * pull_y;
    rows[8 * n + 6] = length * distance, rows[8 * n + 7] = inverse[n] / distance;
  }
  rotate(x, y, plane.periapsis_rate * unit, end + 1);
  Row r[3];
  for (int i = 0; i < 3; ++i)
    for (std::size_t n = 0; n <= end; ++n) r[i][n] = distance * (x[n] * plane.x[i] + y[n] * plane.y[i]);
  rotate(r[0], r[1], plane.node_rate * unit, end + 1);
  for (std::size_t n = 0; n < end; ++n) {
    for (std::size_t i = 0; i < 3; ++i) {
      rows[8 * n + i] = r[i][n];
      rows[8 * n + 3 + i] = static_cast<double>(n + 1) / unit * r[i][n + 1];
    }
  }
}

}  // namespace polhode::kepler
