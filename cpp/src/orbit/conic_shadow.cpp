#include <algorithm>
#include <cmath>
#include <numbers>

#include "orbit/conic_path.hpp"
#include "orbit/shadow.hpp"
#include "polhode/core/error.hpp"

namespace polhode {

using math::DD;

/// The path over chi, in one revolution.
class ConicPath::Track final : public shadow::Curve {
 public:
  explicit Track(const ConicPath& path, double revolution = 0.0)
      : path_(path), since_(DD(revolution) * path.revolution_ - path.since_periapsis_) {}

  shadow::Point<double> at(double p) const override { return find(kepler::compute_anomaly(path_.conic_.alpha.hi, p), p); }
  shadow::Point<DD> at(DD p) const override { return find(kepler::compute_anomaly(path_.conic_.alpha, p), p); }

  DD time(DD p) const override { return DD(path_.t0_) + elapsed(p); }

  shadow::Sizes bound(double from, double to) const override {
    const double alpha = path_.conic_.alpha.hi, q = path_.conic_.q.hi, e = path_.conic_.e.hi, rate = path_.rate_.hi;
    shadow::Sizes most;
    double bend = 0.0;   // of dt/dp by p
    if (alpha > 0.0) {
      most = {(1 + e) / alpha, 1 / std::sqrt(alpha), 1.0};
      bend = e / std::sqrt(alpha) / rate;
    } else {
      const auto u = kepler::compute_anomaly(alpha, std::max(std::abs(from), std::abs(to)));
      const double across2 = q * (1 + e);
      most = {q + e * u.u2, std::sqrt(u.u1 * u.u1 + across2 * u.u0 * u.u0),
              std::sqrt(u.u0 * u.u0 + across2 * alpha * u.u1 * (alpha * u.u1))};
    }
    if (path_.drifts()) {
      const double fast = std::abs(path_.drift_.node) + std::abs(path_.drift_.periapsis), pace = most.r / rate;
      most.curvature += fast * (2 * most.slope * pace + most.r * bend + fast * most.r * pace * pace);
      most.slope += fast * most.r * pace;
    }
    constexpr double room = 1 + 1e-9;   // for their rounding
    return {most.r * room, most.slope * room, most.curvature * room};
  }

 private:
  DD elapsed(DD p) const { return (kepler::compute_time(path_.conic_, p) + since_) / path_.rate_; }

  template <class T>
  static const T& choose(const DD& number) {
    if constexpr (std::is_same_v<T, DD>) return number;
    else return number.hi;
  }
  template <class T>
  static Triple<T> choose(const DDVector& v) {
    if constexpr (std::is_same_v<T, DD>) return v;
    else return round(v);
  }

  template <class T>
  shadow::Point<T> find(const kepler::Anomaly<T>& u, T p) const {
    const T &q = choose<T>(path_.conic_.q), &e = choose<T>(path_.conic_.e);
    const T across = math::sqrt(q * (T(1.0) + e));
    Triple<T> x, z;
    if (!path_.drifts()) {
      x = choose<T>(path_.axes_.x), z = choose<T>(path_.axes_.z);
    } else if constexpr (std::is_same_v<T, DD>) {
      const Axes now = path_.rotate_plane(elapsed(p));
      x = now.x, z = now.z;
    } else {
      const auto [x_axis, z_axis] = path_.rotate_plane(elapsed(DD(p)).hi);
      x = {x_axis[0], x_axis[1], x_axis[2]}, z = {z_axis[0], z_axis[1], z_axis[2]};
    }
    const Triple<T> y = cross(z, x), r = add(scale(x, q - u.u2), scale(y, across * u.u1));
    Triple<T> slope = add(scale(x, -u.u1), scale(y, across * u.u0));
    if (path_.drifts()) {
      const T pace = (q + e * u.u2) / choose<T>(path_.rate_);
      const Triple<T> rotation = add(Triple<T>{T(0.0), T(0.0), T(path_.drift_.node)}, scale(z, T(path_.drift_.periapsis)));
      slope = add(slope, scale(cross(rotation, r), pace));
    }
    return {r, slope};
  }

  const ConicPath& path_;
  DD since_;
};

namespace {

/// Where within a revolution the path is farthest towards the sun: no shadow is there.
double find_noon(const shadow::Curve& curve, const shadow::Cylinder& cylinder, double half) {
  constexpr int parts = 16;
  double noon = 0.0, most = -HUGE_VAL;
  for (int k = 0; k < parts; ++k) {
    const double p = half * (2.0 * k / parts - 1.0);
    const double along = dot(curve.at(p).r, cylinder.sun<double>());
    if (along > most) most = along, noon = p;
  }
  return noon;
}

}  // namespace

std::vector<Eclipse> ConicPath::find_eclipses(const Vector3d& sun, double radius, double first, double last) const {
  if (!(radius <= conic_.q.hi))
    throw InvalidInput("shadow", "at most the least distance of the orbit, " + to_text(conic_.q.hi) + " m", to_text(radius),
                       "the orbit goes through the body");
  const shadow::Cylinder cylinder(sun, radius);
  std::vector<shadow::Edge> edges;
  const DD from = (DD(first) - DD(t0_)) * rate_ + since_periapsis_, to = (DD(last) - DD(t0_)) * rate_ + since_periapsis_;
  if (!is_closed()) {
    // chi at the farther end, or beyond it
    const double far = std::max(std::abs(from.hi), std::abs(to.hi));
    double end = std::sqrt(conic_.q.hi);
    while (kepler::compute_time(conic_, DD(end)).hi < far) end *= 1.25;
    const Track track(*this);
    shadow::find_edges(track, cylinder, -end, end, edges);
    return shadow::join(edges, shadow::is_dark(track, cylinder, -end), first, last);
  }
  const double half = std::numbers::pi / std::sqrt(conic_.alpha.hi);
  const DD whole = math::scaled(math::pi<DD>(), 2.0) / math::sqrt(conic_.alpha);
  const double begin = std::floor((from / revolution_).hi) - 1.0, end = std::ceil((to / revolution_).hi) + 1.0;
  constexpr double most = 1e7;   // revolutions of one span
  if (!(end - begin < most))
    throw InvalidInput("shadow", "of a span of fewer than 1e7 revolutions", to_text(end - begin));
  constexpr double counted = 1e15;   // beyond, a double does not count them
  if (!(std::max(std::abs(begin), std::abs(end)) < counted))
    throw InvalidInput("shadow", "within 1e15 revolutions of t0", to_text(begin));
  if (drifts()) {
    double noon = find_noon(Track(*this, begin), cylinder, half);
    for (double k = begin; k <= end; ++k) {
      const double next = find_noon(Track(*this, k + 1.0), cylinder, half);
      shadow::find_edges(Track(*this, k), cylinder, noon, next + whole.hi, edges);
      noon = next;
    }
    return shadow::join(edges, false, first, last);
  }
  const Track track(*this);
  const double noon = find_noon(track, cylinder, half);
  shadow::find_edges(track, cylinder, noon, noon + whole.hi, edges);
  const DD revolution = revolution_ / rate_;
  const std::vector<shadow::Edge> one = edges;
  edges.clear();
  for (double k = begin - 1.0; k <= end; ++k)
    for (const shadow::Edge& edge : one) edges.push_back({edge.p, edge.t + DD(k) * revolution, edge.enters});
  return shadow::join(edges, false, first, last);
}

}  // namespace polhode
