#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "orbit/path.hpp"
#include "orbit/shadow.hpp"
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

void OrbitTable::require_within(double t) const {
  if (!(t >= t_.front() && t <= t_.back()))
    throw InvalidInput("t", "within the table, " + to_text(t_.front()) + " to " + to_text(t_.back()) + " s", to_text(t));
}

std::size_t OrbitTable::find_piece(double t) const {
  const auto next = std::upper_bound(t_.begin() + 1, t_.end() - 1, t);
  return static_cast<std::size_t>(next - t_.begin()) - 1;
}

OrbitState OrbitTable::at(math::DD time) const {
  const double t = time.hi;
  require_within(t);
  const std::size_t i = find_piece(t);
  const double h = t_[i + 1] - t_[i], s = (t - t_[i]) / h;
  const Vector3d rise = r_[i + 1] - r_[i], a = h * v_[i] - rise, b = rise - h * v_[i + 1];
  // r = r0 + s (rise + (1 - s) (a (1 - s) + b s))
  const double u = 1 - s;
  return {r_[i] + s * (rise + u * (u * a + s * b)),
          (rise + (1 - 2 * s) * (u * a + s * b) + s * u * (b - a)) / h};
}

/// One piece of the table over the time.
class OrbitTable::Track final : public shadow::Curve {
 public:
  Track(const OrbitTable& table, std::size_t i)
      : t0_(table.t_[i]), t1_(table.t_[i + 1]), r0_(to_dd(table.r_[i])), r1_(to_dd(table.r_[i + 1])),
        v0_(to_dd(table.v_[i])), v1_(to_dd(table.v_[i + 1])) {}

  shadow::Point<double> at(double p) const override {
    const shadow::Point<math::DD> now = at(math::DD(p));
    return {round(now.r), round(now.slope)};
  }
  shadow::Point<math::DD> at(math::DD p) const override {
    using math::DD;
    const DD h = DD(t1_) - DD(t0_), s = (p - DD(t0_)) / h, u = DD(1.0) - s;
    const DDVector rise = subtract(r1_, r0_), a = subtract(scale(v0_, h), rise), b = subtract(rise, scale(v1_, h));
    const DDVector bent = add(scale(a, u), scale(b, s));
    const DDVector slope = add(add(rise, scale(bent, u - s)), scale(subtract(b, a), s * u));
    return {add(r0_, scale(add(rise, scale(bent, u)), s)), scale(slope, DD(1.0) / h)};
  }
  shadow::Sizes bound(double from, double to) const override {
    // The second derivative is linear, and largest at an end of the piece.
    const double h = t1_ - t0_;
    const auto bend = [&](double by_rise, double by_v0, double by_v1) {
      const Triple<double> ends = add(scale(round(v0_), by_v0 * h), scale(round(v1_), by_v1 * h));
      return length(add(scale(round(subtract(r1_, r0_)), by_rise), ends)) / (h * h);
    };
    const double curvature = std::max(bend(6.0, -4.0, -2.0), bend(-6.0, 2.0, 4.0));
    const shadow::Point<double> a = at(from), b = at(to);
    const double wide = to - from, slope = std::max(length(a.slope), length(b.slope)) + curvature * wide;
    constexpr double room = 1 + 1e-9;
    return {room * (std::max(length(a.r), length(b.r)) + slope * wide), room * slope, room * curvature};
  }
  math::DD time(math::DD p) const override { return p; }

 private:
  static double length(const Triple<double>& v) { return std::sqrt(dot(v, v)); }

  double t0_, t1_;
  DDVector r0_, r1_, v0_, v1_;
};

std::vector<Eclipse> OrbitTable::find_eclipses(const Vector3d& sun, double radius, double first, double last) const {
  require_within(first), require_within(last);
  const shadow::Cylinder cylinder(sun, radius);
  std::vector<shadow::Edge> edges;
  const std::size_t begin = find_piece(first), end = find_piece(last);
  for (std::size_t i = begin; i <= end; ++i) {
    for (const Vector3d& r : {r_[i], r_[i + 1]})
      if (!(r.norm() >= radius))
        throw InvalidInput("shadow", "at most the least distance of the orbit, " + to_text(r.norm()) + " m", to_text(radius),
                           "the orbit goes through the body");
    shadow::find_edges(Track(*this, i), cylinder, t_[i], t_[i + 1], edges);
  }
  return shadow::join(edges, shadow::is_dark(Track(*this, begin), cylinder, t_[begin]), first, last);
}

void OrbitTable::expand(math::DD, double, int, double*) const {
  throw InvalidInput("orbit", "a conic where a torque takes it", "a table");
}

}  // namespace polhode
