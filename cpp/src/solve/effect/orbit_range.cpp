#include "solve/effect/orbit_range.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "polhode/math/detail/functions.hpp"

#ifndef POLHODE_WITHOUT_ORBITS
#include "polhode/orbit/orbit.hpp"
#endif

namespace polhode::effect {
namespace {

constexpr OrbitRange unknown{0.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};

#ifndef POLHODE_WITHOUT_ORBITS
constexpr double room = 1 + 1e-9;   // positions and elements are rounded

/// How much the secular rates of J2 add: to the mean motion as a share, and to the rotation of the plane [rad/s].
struct DriftBound {
  double faster = 0.0, rotation = 0.0;
};
DriftBound bound_drift(const Orbit& orbit, double q, double e) {
  const auto* elements = std::get_if<OrbitElements>(&orbit.given());
  if (elements == nullptr || elements->j2 == 0.0) return {};
  // |node'| <= k, |periapsis'| <= 2 k and |M' - n| <= k with k = 1.5 n |j2| (R/p)^2: Vallado 2013, section 9.6.
  const double ratio = elements->radius / (q * (1 + e)), share = 1.5 * std::abs(elements->j2) * ratio * ratio;
  const double a = q / (1 - e), n = std::sqrt(orbit.mu() / a) / a;
  return {share, 3 * n * share};
}
#endif

}  // namespace

OrbitRange find_range(const formula::Ephemeris& ephemeris, [[maybe_unused]] double first, [[maybe_unused]] double last) {
#ifndef POLHODE_WITHOUT_ORBITS
  const std::optional<Orbit> orbit = Orbit::from_ephemeris(ephemeris);
  if (!orbit || orbit->kind() == OrbitKind::table) return unknown;
  const double q = orbit->periapsis_distance(), e = orbit->e(), mu = orbit->mu();
  const auto measure = [&](double t) { return orbit->at(t).r.norm(); };
  if (orbit->kind() == OrbitKind::radial) {   // it rises, and may fall again
    const double least = std::min(measure(first), measure(last)) / room;
    const double top = std::isfinite(orbit->period()) ? math::cbrt(mu * orbit->period() * orbit->period() / 9.8) : 0.0;
    return {least, std::max({top * room, measure(first) * room, measure(last) * room}), std::sqrt(2 * mu / least) * room};
  }
  const bool closed = e < 1.0 && std::isfinite(orbit->period());
  const DriftBound drift = closed ? bound_drift(*orbit, q, e) : DriftBound{};
  double least = q, most = closed ? q * (1 + e) / (1 - e) : std::max(measure(first), measure(last));
  if (!closed || last - first < 0.4 * orbit->period()) {
    // At most one apsis lies within: the sign of the radial velocity says which.
    const OrbitState a = orbit->at(first), b = orbit->at(last);
    const bool falls = a.r.dot(a.v) <= 0.0, rises = b.r.dot(b.v) >= 0.0;
    if (!(falls && rises)) least = std::max(least, std::min(a.r.norm(), b.r.norm()));
    if (falls || rises) most = std::min(most, std::max(a.r.norm(), b.r.norm()));
  }
  // Vis viva; the speed is largest at the least distance.
  const double speed = std::sqrt(std::max(2 * mu / least - mu * (1 - e) / q, 0.0)) * (1 + drift.faster) + drift.rotation * most;
  return {least / room, most * room, speed * room};
#else
  static_cast<void>(ephemeris);
  return unknown;
#endif
}

}  // namespace polhode::effect
