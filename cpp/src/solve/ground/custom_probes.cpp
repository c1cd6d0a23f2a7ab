#include "solve/ground/custom_probes.hpp"

#include <algorithm>
#include <cmath>

#include "solve/ground/pieces.hpp"

namespace polhode {
namespace {

constexpr int look_count = 1280;
constexpr double least_gap_spread = 0.2;  // of an interval, by which probes are moved at random
constexpr std::size_t look_neighbours = 4;         // neighbours on each side that a difference is compared with
constexpr double look_outlier = 8.0;           // times their median
constexpr std::size_t most_breaks = 64;   // that are located
constexpr double kept_jump = 0.3;         // of a difference, which remains in ever shorter intervals
constexpr double negligible_jump = 0.02;       // of the accuracy: what a torque may change within the whole span
constexpr double look_rounding = 256 * std::numeric_limits<double>::epsilon();

struct Place {
  double t;
  Vector3d omega;
  Quat attitude;
};

Place between(const Place& a, const Place& b, double s) {
  const double sign = a.attitude.x * b.attitude.x + a.attitude.y * b.attitude.y + a.attitude.z * b.attitude.z +
                                  a.attitude.w * b.attitude.w < 0 ? -1.0 : 1.0;
  const double r = sign * s, l = 1 - s;
  return {a.t, l * a.omega + s * b.omega,
          {l * a.attitude.x + r * b.attitude.x, l * a.attitude.y + r * b.attitude.y,
           l * a.attitude.z + r * b.attitude.z, l * a.attitude.w + r * b.attitude.w}};
}

/// The probes between two known edges, in the order of time.
class Stretch {
 public:
  Stretch(const Scene& scene, std::vector<Place> places) : scene_(scene), places_(std::move(places)) {
    for (const Place& place : places_) torque_.push_back(call(place, place.t));
  }

  double largest() const {
    double size = 0.0;
    for (const Vector3d& tau : torque_) size = std::max(size, tau.norm());
    return size;
  }

  void find(double floor, Probes& probes) const {
    const std::size_t n = places_.size();
    if (n < 2 * look_neighbours) return;
    std::vector<double> change(n - 1), bend(n - 1, 0.0);
    const double spacing = (places_[n - 1].t - places_[0].t) / static_cast<double>(n - 1);
    for (std::size_t i = 0; i + 1 < n; ++i) change[i] = (torque_[i + 1] - torque_[i]).norm();
    for (std::size_t i = 1; i + 1 < n; ++i) bend[i] = (slope(i) - slope(i - 1)).norm() * spacing;
    std::vector<unsigned char> jumps(n, 0);
    for (std::size_t i = 0; i + 1 < n; ++i) {
      if (!(change[i] > floor + look_outlier * typical(change, i, 0))) continue;
      if (probes.breaks.size() >= most_breaks) {
        probes.too_many = true;
        return;
      }
      jumps[i] = jumps[i + 1] = locate_jump(i, change[i], probes);
    }
    for (std::size_t i = 1; i + 1 < n; ++i) {
      if (jumps[i] || jumps[i - 1] || !(bend[i] > floor + look_outlier * typical(bend, i, 1))) continue;
      if (probes.breaks.size() >= most_breaks) {
        probes.too_many = true;
        return;
      }
      if (locate_kink(i, probes)) ++i;   // the next bend is the same one
    }
  }

 private:
  Vector3d call(const Place& place, double t) const {
    const double q[4] = {place.attitude.x, place.attitude.y, place.attitude.z, place.attitude.w};
    double sum[3] = {0.0, 0.0, 0.0};
    const TorqueInput in{t, place.omega.data(), q, scene_.inertia_B().matrix()};
    for (const AnyTorque& torque : scene_.torques()) {
      if (const auto* custom = std::get_if<torques::Custom>(&torque)) {
        custom->add(in, sum);
      } else if (const auto* during = std::get_if<torques::During>(&torque)) {
        if (std::holds_alternative<torques::Custom>(during->torque())) during->add(in, sum);
      }
    }
    return {sum[0], sum[1], sum[2]};
  }

  Vector3d slope(std::size_t i) const {
    return (torque_[i + 1] - torque_[i]) / (places_[i + 1].t - places_[i].t);
  }

  /// The median of the neighbours of a difference, without the `skipped` next ones.
  static double typical(const std::vector<double>& values, std::size_t i, std::size_t skipped) {
    std::vector<double> near;
    for (std::size_t k = 1 + skipped; k <= look_neighbours + skipped; ++k) {
      if (i >= k) near.push_back(values[i - k]);
      if (i + k < values.size()) near.push_back(values[i + k]);
    }
    const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
    std::nth_element(near.begin(), middle, near.end());
    return *middle;
  }

  /// Halves an interval towards the larger change of `at`, as long as most of the change remains.
  template <class At>
  static bool bisect(double& low, double& high, double least, const At& at) {
    Vector3d a = at(low), b = at(high);
    const double whole = (b - a).norm(), width = high - low;
    for (;;) {
      const double middle = low + 0.5 * (high - low);
      if (!(middle > low && middle < high) || high - low <= least) return true;
      const Vector3d m = at(middle);
      if ((m - a).norm() >= (b - m).norm()) {
        high = middle, b = m;
      } else {
        low = middle, a = m;
      }
      // Continuous; what changes within a small part of an interval is treated as a jump.
      if (!((b - a).norm() > kept_jump * whole)) return high - low < width / 64;
    }
  }

  /// True if the torque jumps between two probes, with the time or with the state.
  bool locate_jump(std::size_t i, double change, Probes& probes) const {
    const Place &here = places_[i], &next = places_[i + 1];
    const double by_time = (call(here, next.t) - torque_[i]).norm();
    if (by_time > kept_jump * change) {
      double low = here.t, high = next.t;
      if (!bisect(low, high, 0.0, [&](double t) { return call(here, t); })) return false;
      probes.breaks.push_back(high);
      return true;
    }
    double low = 0.0, high = 1.0;
    const auto along = [&](double s) { return call(between(here, next, s), here.t); };
    if (!((along(high) - along(low)).norm() > kept_jump * change) || !bisect(low, high, 1e-9, along)) return false;
    probes.state_jump = here.t;
    return true;
  }

  /// Halves the three points around a probe towards the largest second difference. It halves with the interval at a
  /// kink, and is quartered elsewhere.
  bool locate_kink(std::size_t i, Probes& probes) const {
    const Place& here = places_[i];
    double a = places_[i - 1].t, b = places_[i + 1].t, m = 0.5 * (a + b);
    const auto at = [&](double t) { return call(here, t); };
    Vector3d fa = at(a), fm = at(m), fb = at(b);
    const auto second = [](const Vector3d& l, const Vector3d& c, const Vector3d& r) { return (l - 2 * c + r).norm(); };
    const double whole = second(fa, fm, fb), size = std::max({fa.norm(), fm.norm(), fb.norm()});
    double bend = whole;
    for (int k = 0; k < 48; ++k) {
      const double l = 0.5 * (a + m), r = 0.5 * (m + b);
      if (!(a < l && l < m && m < r && r < b) || bend < look_rounding * size) break;
      const Vector3d fl = at(l), fr = at(r);
      const double left = second(fa, fl, fm), middle = second(fl, fm, fr), right = second(fm, fr, fb);
      bend = std::max({left, middle, right});
      if (bend == middle) {
        a = l, fa = fl, b = r, fb = fr;
      } else if (bend == left) {
        b = m, fb = fm, m = l, fm = fl;
      } else {
        a = m, fa = fm, m = r, fm = fr;
      }
      if (k == 5 && !(bend > 0.2 / 64 * whole)) return false;
    }
    if (!(b - a < (places_[i + 1].t - places_[i - 1].t) / 64)) return false;
    probes.breaks.push_back(m);
    return true;
  }

  const Scene& scene_;
  const std::vector<Place> places_;
  std::vector<Vector3d> torque_;
};

}  // namespace

std::vector<double> spread_probes(double begin, double end) {
  constexpr double golden = 0.6180339887498949;
  std::vector<double> times;
  for (int i = 0; i < look_count; ++i) {
    const double moved = 0.5 + least_gap_spread * (i * golden - std::floor(i * golden) - 0.5);
    times.push_back(begin + (end - begin) * ((i + moved) / look_count));
  }
  return times;
}

Probes probe(const Scene& scene, const Trajectory& motion, std::size_t first, double accuracy) {
  Probes probes;
  if (motion.omega.empty() || motion.t.size() <= first + 1) return probes;
  std::vector<double> edges;
  const Pieces pieces = cut(scene);
  for (const Piece* piece : pieces.all()) edges.insert(edges.end(), {piece->begin, piece->end});
  std::sort(edges.begin(), edges.end());
  std::vector<Stretch> stretches;
  std::vector<Place> places;
  const auto close = [&] {
    if (!places.empty()) stretches.emplace_back(scene, std::move(places));
    places.clear();
  };
  double rate = scene.omega().norm();
  for (std::size_t i = first; i < motion.t.size(); ++i) {
    const double t = motion.t[i];
    if (!places.empty() && std::upper_bound(edges.begin(), edges.end(), places.back().t) !=
                               std::upper_bound(edges.begin(), edges.end(), t))
      close();
    const double *w = motion.omega.data() + 3 * i, *q = motion.attitude.data() + 4 * i;
    places.push_back({t, {w[0], w[1], w[2]},
                      motion.attitude.empty() ? scene.attitude() : Quat{q[0], q[1], q[2], q[3]}});
    rate = std::max(rate, places.back().omega.norm());
  }
  close();
  const double span = motion.t.back() - motion.t[first], momentum = scene.inertia_B().moments()[0] * rate;
  double largest = 0.0;
  for (const Stretch& stretch : stretches) largest = std::max(largest, stretch.largest());
  const double floor = std::max(look_rounding * largest, negligible_jump * accuracy * momentum / span);
  for (const Stretch& stretch : stretches) stretch.find(floor, probes);
  std::sort(probes.breaks.begin(), probes.breaks.end());
  return probes;
}

}  // namespace polhode
