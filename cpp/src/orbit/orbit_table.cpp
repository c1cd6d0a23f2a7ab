#include <algorithm>
#include <cmath>
#include <string>

#include "orbit/path.hpp"
#include "polhode/core/error.hpp"

namespace polhode {

OrbitTable::OrbitTable(OrbitRows rows)
    : Path(rows), t_(std::move(rows.t)), r_(std::move(rows.r)), v_(std::move(rows.v)), mu_(rows.mu) {
  if (t_.size() < 2) throw InvalidInput("t", "at least two times", std::to_string(t_.size()));
  if (r_.size() != t_.size() || v_.size() != t_.size())
    throw InvalidInput("r, v", "one row for each of the " + std::to_string(t_.size()) + " times",
                       std::to_string(r_.size()) + " and " + std::to_string(v_.size()));
  for (std::size_t i = 0; i < t_.size(); ++i) {
    if (!std::isfinite(t_[i]) || !r_[i].allFinite() || !v_[i].allFinite())
      throw InvalidInput("table", "finite", "row " + std::to_string(i));
    if (i > 0 && !(t_[i] > t_[i - 1])) throw InvalidInput("t", "increasing", to_text(t_[i]) + " after " + to_text(t_[i - 1]));
  }
  if (mu_ <= 0.0 || std::isinf(mu_)) throw InvalidInput("mu", "positive and finite", to_text(mu_));
}

OrbitState OrbitTable::at(math::DD time) const {
  const double t = time.hi;
  if (!(t >= t_.front() && t <= t_.back()))
    throw InvalidInput("t", "within the table, " + to_text(t_.front()) + " to " + to_text(t_.back()) + " s", to_text(t));
  const auto next = std::upper_bound(t_.begin() + 1, t_.end() - 1, t);
  const std::size_t i = static_cast<std::size_t>(next - t_.begin()) - 1;
  const double h = t_[i + 1] - t_[i], s = (t - t_[i]) / h;
  const Vector3d rise = r_[i + 1] - r_[i], a = h * v_[i] - rise, b = rise - h * v_[i + 1];
  // r = r0 + s (rise + (1 - s) (a (1 - s) + b s))
  const double u = 1 - s;
  return {r_[i] + s * (rise + u * (u * a + s * b)),
          (rise + (1 - 2 * s) * (u * a + s * b) + s * u * (b - a)) / h};
}

void OrbitTable::expand(math::DD, double, int, double*) const {
  throw InvalidInput("orbit", "a conic where a torque takes it", "a table");
}

}  // namespace polhode
