#include "orbit/conic_path.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <tuple>

#include "polhode/core/error.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode {

using math::DD;

namespace {

constexpr double circle = 1e-17;   // below it the eccentricity moves r by less than rounding, and has few digits

/// Squares of extreme starts overflow.
void require_held(std::initializer_list<DD> parts) {
  for (const DD& part : parts)
    if (!std::isfinite(part.hi)) throw InvalidInput("orbit", "of elements that a double holds", to_text(part.hi));
}

}  // namespace

ConicPath::ConicPath(double mu, const Vector3d& r0, const Vector3d& v0, double t0)
    : Path(OrbitStart{mu, r0, v0, t0}), mu_(mu), t0_(t0) {
  const DDVector r = to_dd(r0), v = to_dd(v0);
  const DD distance = math::sqrt(dot(r, r)), root_mu = math::sqrt(DD(mu));
  const DDVector h = cross(r, v);
  const DD p = dot(h, h) / DD(mu), sigma = dot(r, v) / root_mu;
  conic_.alpha = DD(2.0) / distance - dot(v, v) / DD(mu);
  // e towards the periapsis, times mu
  const DDVector towards = subtract(scale(r, dot(v, v) - DD(mu) / distance), scale(v, dot(r, v)));
  conic_.e = math::sqrt(dot(towards, towards)) / DD(mu);
  radial_ = p.hi == 0.0;
  if (radial_) conic_.e = DD(1.0);
  const bool round_orbit = conic_.e.hi < circle;
  if (round_orbit) conic_.e = DD(0.0);
  conic_.q = round_orbit ? distance : p / (DD(1.0) + conic_.e);
  if (round_orbit) conic_.alpha = DD(1.0) / distance;
  axes_.x = radial_ ? scale(normalize(r), DD(-1.0)) : normalize(round_orbit ? r : towards);
  axes_.z = radial_ ? DDVector{} : normalize(h);
  x_ = to_vector(round(axes_.x)), z_ = to_vector(round(axes_.z));
  require_held({conic_.q, conic_.e, conic_.alpha});
  start(kepler::find_chi(conic_, distance, sigma));
}

ConicPath::ConicPath(const OrbitElements& given) : Path(given), mu_(given.mu), t0_(given.t0) {
  const DD e(given.e);
  conic_.e = e;
  conic_.q = std::isnan(given.semi_major_axis) ? DD(given.periapsis_distance)
                                               : DD(given.semi_major_axis) * (DD(1.0) - e);
  conic_.alpha = (DD(1.0) - e) / conic_.q;
  require_held({conic_.q, conic_.e, conic_.alpha});
  const DD chi = kepler::find_chi(conic_, given.anomaly);
  if (std::isnan(chi.hi))
    throw InvalidInput("anomaly", "between the asymptotes of the hyperbola", to_text(given.anomaly));
  angles_ = {given.inclination, given.node, given.periapsis};
  if (given.j2 != 0.0) set_drift(given);
  std::tie(x_, z_) = rotate_plane(0.0);
  axes_ = rotate_plane(DD(0.0));
  start(chi);
}

OrbitState ConicPath::at(DD t) const {
  const kepler::PlaneState now = find_state(t);
  const auto [x_axis, z_axis] = find_axes(t);
  const Vector3d side = z_axis.cross(x_axis), r = now.x * x_axis + now.y * side;
  const Vector3d v = now.vx * x_axis + now.vy * side;
  if (!drifts()) return {r, v};
  return {r, v + (drift_.node * Vector3d(0.0, 0.0, 1.0) + drift_.periapsis * z_axis).cross(r)};
}

void ConicPath::expand(DD t, double unit, int order, double* rows) const {
  const auto [x_axis, z_axis] = find_axes(t);
  const kepler::MovingPlane plane{x_axis, z_axis.cross(x_axis), drift_.node, drift_.periapsis};
  kepler::expand(rate_.hi * rate_.hi, find_state(t), plane, unit, order, rows);
}

OrbitKind ConicPath::kind() const {
  if (radial_) return OrbitKind::radial;
  if (conic_.e.hi == 0.0) return OrbitKind::circular;
  return is_closed()                ? OrbitKind::elliptic
         : conic_.alpha.hi == 0.0 ? OrbitKind::parabolic
                                  : OrbitKind::hyperbolic;
}

double ConicPath::period() const {
  return is_closed() ? (revolution_ / rate_).hi : std::numeric_limits<double>::infinity();
}

/// The axes to the periapsis and along the angular momentum.
std::pair<Vector3d, Vector3d> ConicPath::find_axes(DD t) const {
  if (!drifts()) return {x_, z_};
  return rotate_plane((t - DD(t0_)).hi);
}

/// In the plane of the conic.
kepler::PlaneState ConicPath::find_state(DD t) const {
  if (!std::isfinite(t.hi)) throw InvalidInput("t", "finite", to_text(t.hi));
  DD n = (t - DD(t0_)) * rate_ + since_periapsis_;   // sqrt(mu) times the time from a periapsis
  if (radial_ && meets_centre(n)) throw InvalidInput("t", "before a radial orbit meets the centre", to_text(t.hi));
  if (is_closed()) n = n - DD(std::round((n / revolution_).hi)) * revolution_;
  const kepler::Anomaly<double> u = kepler::solve(conic_, n.hi);
  const double q = conic_.q.hi, e = conic_.e.hi;
  const double distance = q + e * u.u2, across = std::sqrt(q * (1 + e)), fast = rate_.hi / distance;
  return {q - u.u2, across * u.u1, -fast * u.u1, fast * across * u.u0};
}

/// The time of the start from the periapsis, and that of a revolution; both times sqrt(mu).
void ConicPath::start(DD chi) {
  since_periapsis_ = kepler::compute_time(conic_, chi);
  if (is_closed()) revolution_ = math::scaled(math::pi<DD>(), 2.0) / (conic_.alpha * math::sqrt(conic_.alpha));
  if (radial_ && since_periapsis_.hi < 0.0 && is_closed()) since_periapsis_ = since_periapsis_ + revolution_;
  rate_ = math::sqrt(DD(mu_)) * DD(speed_up_);
  require_held({since_periapsis_, revolution_, rate_});
}

/// Whether a radial orbit is at the centre between the start and the time n.
bool ConicPath::meets_centre(DD n) const {
  if (is_closed()) return !(n.hi > 0.0 && (n - revolution_).hi < 0.0);
  return !(since_periapsis_.hi < 0.0 ? n.hi < 0.0 : n.hi > 0.0);
}

/// The axes of the plane after a time: rotations about z, x and z.
std::pair<Vector3d, Vector3d> ConicPath::rotate_plane(double elapsed) const {
  const auto [sn, cn] = math::sincos(angles_.node + drift_.node * elapsed);
  const auto [si, ci] = math::sincos(angles_.inclination);
  const auto [sw, cw] = math::sincos(angles_.periapsis + drift_.periapsis * elapsed);
  return {{cn * cw - sn * ci * sw, sn * cw + cn * ci * sw, si * sw}, {sn * si, -cn * si, ci}};
}

ConicPath::Axes ConicPath::rotate_plane(DD elapsed) const {
  const auto [sn, cn] = math::sincos(DD(angles_.node) + DD(drift_.node) * elapsed);
  const auto [si, ci] = math::sincos(DD(angles_.inclination));
  const auto [sw, cw] = math::sincos(DD(angles_.periapsis) + DD(drift_.periapsis) * elapsed);
  return {{cn * cw - sn * ci * sw, sn * cw + cn * ci * sw, si * sw}, {sn * si, -(cn * si), ci}};
}

/// Vallado 2013, "Fundamentals of Astrodynamics and Applications", section 9.6.
void ConicPath::set_drift(const OrbitElements& given) {
  const double e = given.e, alpha = conic_.alpha.hi, p = conic_.q.hi * (1 + e);
  const double n = std::sqrt(mu_) * alpha * std::sqrt(alpha), ratio = given.radius / p;
  const double k = 1.5 * n * given.j2 * ratio * ratio, c = math::cos(given.inclination);
  const double sine2 = 1 - c * c;
  drift_ = {-k * c, k * (2 - 2.5 * sine2)};
  speed_up_ = 1 + k * std::sqrt((1 - e) * (1 + e)) * (1 - 1.5 * sine2) / n;
}

}  // namespace polhode
