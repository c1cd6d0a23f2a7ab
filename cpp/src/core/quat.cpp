#include "polhode/core/quat.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "polhode/core/error.hpp"

namespace polhode {

double norm(const Quat& q) {
  const double square = (q.x * q.x + q.y * q.y) + (q.z * q.z + q.w * q.w);
  if (square > 1e-250 && square < 1e300) return std::sqrt(square);
  const double largest = std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z), std::abs(q.w)});
  if (largest == 0.0 || !std::isfinite(largest) || std::isnan(square)) return square;
  int exponent = 0;
  std::frexp(largest, &exponent);
  const auto scaled = [&](double x) { return std::ldexp(x, -exponent); };
  return std::ldexp(norm({scaled(q.x), scaled(q.y), scaled(q.z), scaled(q.w)}), exponent);
}

Quat make_attitude(const Quat& q) {
  constexpr double rounding = std::numeric_limits<double>::epsilon();
  const double square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (std::abs(square - 1.0) <= rounding) return q;   // the norm below is then within 4 * rounding, and slow
  const double n = norm(q);
  if (!std::isfinite(n)) {
    throw InvalidInput("attitude", "a finite quaternion (x, y, z, w)",
                       "(" + to_text(q.x) + ", " + to_text(q.y) + ", " + to_text(q.z) + ", " + to_text(q.w) + ")");
  }
  if (n == 0.0) throw InvalidInput("attitude", "a unit quaternion (x, y, z, w)", "one of norm 0");
  if (std::abs(n - 1.0) > 1e-6) {
    throw InvalidInput("attitude", "a unit quaternion (x, y, z, w)", "norm " + to_text(n),
                       "normalise it first, if it is meant to be an attitude");
  }
  if (std::abs(n - 1.0) <= 4 * rounding) return q;   // so that doing it twice changes nothing
  return {q.x / n, q.y / n, q.z / n, q.w / n};
}

}  // namespace polhode
