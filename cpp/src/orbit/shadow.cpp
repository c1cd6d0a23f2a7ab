#include "orbit/shadow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "polhode/core/error.hpp"
#include "polhode/core/interrupt.hpp"

namespace polhode::shadow {
namespace {

using math::DD;

constexpr double infinite = std::numeric_limits<double>::infinity();

template <class T>
struct Reach {
  T g, dg;       ///< |r|^2 - (r.s)^2 - radius^2 and its derivative by the parameter
  T along;       ///< r.s
};

template <class T>
Reach<T> measure(const Curve& curve, const Cylinder& cylinder, T p) {
  const Point<T> now = curve.at(p);
  const Triple<T>& s = cylinder.sun<T>();
  const T along = dot(now.r, s), radius(cylinder.radius());
  const Triple<T> across = subtract(now.r, scale(s, along));
  return {dot(across, across) - radius * radius, T(2.0) * dot(across, now.slope), along};
}

/// In double, and in double-double where its rounding could change the sign.
Reach<double> measure_surely(const Curve& curve, const Cylinder& cylinder, double p) {
  constexpr double doubtful = 1e-11;   // of the squares that cancel
  const Reach<double> now = measure(curve, cylinder, p);
  const double size = now.along * now.along + std::abs(now.g) + cylinder.radius() * cylinder.radius();
  if (!(std::abs(now.g) < doubtful * size)) return now;
  const Reach<DD> sure = measure(curve, cylinder, DD(p));
  return {sure.g.hi, sure.dg.hi, sure.along.hi};
}

struct Sample {
  double p;
  Reach<double> reach;
};

class Search {
 public:
  Search(const Curve& curve, const Cylinder& cylinder, std::vector<Edge>& edges)
      : curve_(curve), cylinder_(cylinder), edges_(edges) {}

  Sample look(double p) {
    if (++looks_ > most_looks)
      throw InvalidInput("shadow", "of a radius that can be searched", to_text(cylinder_.radius()),
                         "it is too small for so long an orbit");
    if (looks_ % 4096 == 0) check_interrupt();
    const Sample now{p, measure_surely(curve_, cylinder_, p)};
    // A NaN would never end the search.
    if (!std::isfinite(now.reach.g) || !std::isfinite(now.reach.dg))
      throw InvalidInput("orbit", "with distances whose squares are finite", to_text(now.reach.g) + " m^2");
    return now;
  }

  void search(const Sample& a, const Sample& b) {
    const Reach<double>&x = a.reach, &y = b.reach;
    const double h = b.p - a.p, middle = a.p + 0.5 * h;
    const Sizes most = curve_.bound(a.p, b.p);
    if (std::min(x.along, y.along) > most.curvature * h * h / 8) return;   // on the side of the sun
    const double bend = 2.0 * (most.slope * most.slope + most.r * most.curvature), sag = bend * h * h / 8;
    if (std::min(x.g, y.g) > sag || std::max(x.g, y.g) < -sag) return;
    const bool changes = (x.g < 0.0) != (y.g < 0.0);
    if (!(a.p < middle && middle < b.p)) {
      if (changes) add(a.p, x.g > y.g);
      return;
    }
    const Sample m = look(middle);
    if (std::abs(m.reach.dg) > bend * h / 2) {   // of one sign within
      if (changes) add(solve(a, b, m), x.g > y.g);
      return;
    }
    search(a, m), search(m, b);
  }

 private:
  /// Newton's steps within a bracket.
  double solve(Sample a, Sample b, Sample m) {
    const bool rises = a.reach.g < b.reach.g;
    for (int k = 0; k < 100; ++k) {
      ((m.reach.g < 0.0) == rises ? a : b) = m;
      const double newton = m.p - m.reach.g / m.reach.dg;
      const double next = newton > a.p && newton < b.p ? newton : a.p + 0.5 * (b.p - a.p);
      if (next == m.p || !(a.p < next && next < b.p)) return m.p;
      const bool close = std::abs(next - m.p) <= 1e-15 * std::abs(next);
      m = look(next);
      if (close) break;
    }
    return m.p;
  }

  /// An edge near p, to the digits of double-double.
  void add(double near, bool enters) {
    DD p(near);
    Reach<DD> now = measure(curve_, cylinder_, p);
    double last = infinite;
    for (int k = 0; k < 8 && now.dg.hi != 0.0; ++k) {
      const DD step = now.g / now.dg;
      if (!(std::abs(step.hi) < 0.5 * last)) break;
      p = p - step, last = std::abs(step.hi);
      now = measure(curve_, cylinder_, p);
    }
    if (now.along.hi < 0.0) edges_.push_back({p, curve_.time(p), enters});
  }

  static constexpr int most_looks = 20'000'000;   // some seconds: an orbit of the Earth needs a hundred

  const Curve& curve_;
  const Cylinder& cylinder_;
  std::vector<Edge>& edges_;
  int looks_ = 0;
};

}  // namespace

bool is_dark(const Curve& curve, const Cylinder& cylinder, double p) {
  const Reach<double> now = measure_surely(curve, cylinder, p);
  return now.along < 0.0 && now.g < 0.0;
}

void find_edges(const Curve& curve, const Cylinder& cylinder, double from, double to, std::vector<Edge>& edges) {
  constexpr int parts = 16;
  Search search(curve, cylinder, edges);
  Sample before = search.look(from);
  for (int k = 1; k <= parts; ++k) {
    check_interrupt();
    const Sample next = search.look(k == parts ? to : from + (to - from) * (static_cast<double>(k) / parts));
    search.search(before, next);
    before = next;
  }
}

std::vector<Eclipse> join(const std::vector<Edge>& edges, bool starts_dark, double first, double last) {
  std::vector<Eclipse> dark;
  double begin = starts_dark ? -infinite : infinite;
  const auto add = [&](double end) {
    if (begin < end && end > first && begin < last) dark.push_back({begin, end});
    begin = infinite;
  };
  for (const Edge& edge : edges) {
    if (edge.enters) begin = std::min(begin, edge.t.hi);
    else add(edge.t.hi);
  }
  if (begin < infinite) add(infinite);
  return dark;
}

}  // namespace polhode::shadow
