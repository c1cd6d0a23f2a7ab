#include "polhode/orbit/orbit.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

#include "orbit/kepler.hpp"
#include "orbit/kepler_series.hpp"
#include "orbit/path.hpp"
#include "polhode/core/error.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode {
namespace {

using math::DD;

constexpr double circle = 1e-17;   // below it the eccentricity moves r by less than rounding, and has few digits

struct DDVector {
  DD x, y, z;
};

DDVector to_dd(const Vector3d& v) { return {DD(v[0]), DD(v[1]), DD(v[2])}; }
DD dot(const DDVector& a, const DDVector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
DDVector scale(const DDVector& a, DD s) { return {a.x * s, a.y * s, a.z * s}; }
DDVector subtract(const DDVector& a, const DDVector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
DDVector cross(const DDVector& a, const DDVector& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Vector3d to_unit(const DDVector& v) {
  const DDVector unit = scale(v, DD(1.0) / math::sqrt(dot(v, v)));
  return {unit.x.hi, unit.y.hi, unit.z.hi};
}

void require_positive(const char* name, double value) {
  if (!(value > 0.0 && std::isfinite(value))) throw InvalidInput(name, "positive and finite", to_text(value));
}

void require_finite(const char* name, double value) {
  if (!std::isfinite(value)) throw InvalidInput(name, "finite", to_text(value));
}

using Bits = std::vector<double>;

Bits list_numbers(const OrbitStart& s) {
  return {s.mu, s.r0[0], s.r0[1], s.r0[2], s.v0[0], s.v0[1], s.v0[2], s.t0};
}
Bits list_numbers(const OrbitElements& e) {
  return {e.mu, e.periapsis_distance, e.semi_major_axis, e.e, e.inclination, e.node, e.periapsis, e.anomaly, e.t0, e.j2,
          e.radius};
}
Bits list_numbers(const OrbitRows& rows) {
  Bits all = rows.t;
  all.push_back(rows.mu);
  for (const auto* list : {&rows.r, &rows.v})
    for (const Vector3d& one : *list) all.insert(all.end(), one.data(), one.data() + 3);
  return all;
}

bool have_same_bits(const OrbitGiven& a, const OrbitGiven& b) {
  if (a.index() != b.index()) return false;
  const auto list = [](const auto& one) { return list_numbers(one); };
  const Bits left = std::visit(list, a), right = std::visit(list, b);
  return left.size() == right.size() && std::memcmp(left.data(), right.data(), sizeof(double) * left.size()) == 0;
}

/// How the plane of an orbit moves under the secular part of J2 [rad/s].
struct Drift {
  double node = 0.0, periapsis = 0.0;
};

class ConicPath final : public Orbit::Path {
 public:
  ConicPath(double mu, const Vector3d& r0, const Vector3d& v0, double t0)
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
    const bool round = conic_.e.hi < circle;
    if (round) conic_.e = DD(0.0);
    conic_.q = round ? distance : p / (DD(1.0) + conic_.e);
    if (round) conic_.alpha = DD(1.0) / distance;
    x_ = radial_ ? -to_unit(r) : to_unit(round ? r : towards);
    z_ = radial_ ? Vector3d(0.0, 0.0, 0.0) : to_unit(h);
    start(kepler::find_chi(conic_, distance, sigma));
  }

  explicit ConicPath(const OrbitElements& given) : Path(given), mu_(given.mu), t0_(given.t0) {
    const DD e(given.e);
    conic_.e = e;
    conic_.q = std::isnan(given.semi_major_axis) ? DD(given.periapsis_distance)
                                                 : DD(given.semi_major_axis) * (DD(1.0) - e);
    conic_.alpha = (DD(1.0) - e) / conic_.q;
    const DD chi = kepler::find_chi(conic_, given.anomaly);
    if (std::isnan(chi.hi))
      throw InvalidInput("anomaly", "between the asymptotes of the hyperbola", to_text(given.anomaly));
    angles_ = {given.inclination, given.node, given.periapsis};
    if (given.j2 != 0.0) set_drift(given);
    rotate_plane(0.0);
    start(chi);
  }

  OrbitState at(DD t) const override {
    const kepler::PlaneState now = find_state(t);
    const auto [x_axis, z_axis] = find_axes(t);
    const Vector3d side = z_axis.cross(x_axis), r = now.x * x_axis + now.y * side;
    const Vector3d v = now.vx * x_axis + now.vy * side;
    if (!drifts()) return {r, v};
    return {r, v + (drift_.node * Vector3d(0.0, 0.0, 1.0) + drift_.periapsis * z_axis).cross(r)};
  }

  void expand(DD t, double unit, int order, double* rows) const override {
    const auto [x_axis, z_axis] = find_axes(t);
    const kepler::MovingPlane plane{x_axis, z_axis.cross(x_axis), drift_.node, drift_.periapsis};
    kepler::expand(rate_.hi * rate_.hi, find_state(t), plane, unit, order, rows);
  }

  OrbitKind kind() const override {
    if (radial_) return OrbitKind::radial;
    if (conic_.e.hi == 0.0) return OrbitKind::circular;
    return conic_.alpha.hi > 0.0    ? OrbitKind::elliptic
           : conic_.alpha.hi == 0.0 ? OrbitKind::parabolic
                                    : OrbitKind::hyperbolic;
  }
  double mu() const override { return mu_; }
  double t0() const override { return t0_; }
  double e() const override { return conic_.e.hi; }
  double period() const override {
    return conic_.alpha.hi > 0.0 ? (revolution_ / rate_).hi : std::numeric_limits<double>::infinity();
  }
  double periapsis_distance() const override { return conic_.q.hi; }

 private:
  struct Angles {
    double inclination = 0.0, node = 0.0, periapsis = 0.0;
  };

  bool drifts() const { return drift_.node != 0.0 || drift_.periapsis != 0.0; }

  /// The axes to the periapsis and along the angular momentum.
  std::pair<Vector3d, Vector3d> find_axes(DD t) const {
    if (!drifts()) return {x_, z_};
    ConicPath now(*this);
    now.rotate_plane((t - DD(t0_)).hi);
    return {now.x_, now.z_};
  }

  /// In the plane of the conic.
  kepler::PlaneState find_state(DD t) const {
    if (!std::isfinite(t.hi)) throw InvalidInput("t", "finite", to_text(t.hi));
    DD n = (t - DD(t0_)) * rate_ + since_periapsis_;   // sqrt(mu) times the time from a periapsis
    if (radial_ && meets_centre(n)) throw InvalidInput("t", "before a radial orbit meets the centre", to_text(t.hi));
    if (conic_.alpha.hi > 0.0) n = n - DD(std::round((n / revolution_).hi)) * revolution_;
    const kepler::Anomaly<double> u = kepler::solve(conic_, n.hi);
    const double q = conic_.q.hi, e = conic_.e.hi;
    const double distance = q + e * u.u2, across = std::sqrt(q * (1 + e)), fast = rate_.hi / distance;
    return {q - u.u2, across * u.u1, -fast * u.u1, fast * across * u.u0};
  }

  /// The time of the start from the periapsis, and that of a revolution; both times sqrt(mu).
  void start(DD chi) {
    since_periapsis_ = kepler::compute_time(conic_, chi);
    if (conic_.alpha.hi > 0.0) revolution_ = math::scaled(math::pi<DD>(), 2.0) / (conic_.alpha * math::sqrt(conic_.alpha));
    if (radial_ && since_periapsis_.hi < 0.0 && conic_.alpha.hi > 0.0) since_periapsis_ = since_periapsis_ + revolution_;
    rate_ = math::sqrt(DD(mu_)) * DD(speed_up_);
  }

  /// Whether a radial orbit is at the centre between the start and the time n.
  bool meets_centre(DD n) const {
    if (conic_.alpha.hi > 0.0) return !(n.hi > 0.0 && (n - revolution_).hi < 0.0);
    return !(since_periapsis_.hi < 0.0 ? n.hi < 0.0 : n.hi > 0.0);
  }

  /// The axes of the plane after a time: rotations about z, x and z.
  void rotate_plane(double elapsed) {
    const auto [sn, cn] = math::sincos(angles_.node + drift_.node * elapsed);
    const auto [si, ci] = math::sincos(angles_.inclination);
    const auto [sw, cw] = math::sincos(angles_.periapsis + drift_.periapsis * elapsed);
    x_ = {cn * cw - sn * ci * sw, sn * cw + cn * ci * sw, si * sw};
    z_ = {sn * si, -cn * si, ci};
  }

  /// Vallado 2013, "Fundamentals of Astrodynamics and Applications", section 9.6.
  void set_drift(const OrbitElements& given) {
    const double e = given.e, alpha = conic_.alpha.hi, p = conic_.q.hi * (1 + e);
    const double n = std::sqrt(mu_) * alpha * std::sqrt(alpha), ratio = given.radius / p;
    const double k = 1.5 * n * given.j2 * ratio * ratio, c = math::cos(given.inclination);
    const double sine2 = 1 - c * c;
    drift_ = {-k * c, k * (2 - 2.5 * sine2)};
    speed_up_ = 1 + k * std::sqrt((1 - e) * (1 + e)) * (1 - 1.5 * sine2) / n;
  }

  double mu_, t0_;
  kepler::Conic conic_{};
  Vector3d x_, z_;   ///< to the periapsis, and along the angular momentum
  bool radial_ = false;
  Angles angles_ = {};
  Drift drift_ = {};
  double speed_up_ = 1.0;   ///< of the mean motion by J2
  DD since_periapsis_, revolution_, rate_;
};

}  // namespace

void Orbit::Path::evaluate(DD t, double* numbers) const {
  const OrbitState state = at(t);
  const double distance = state.r.norm();
  for (int i = 0; i < 3; ++i) numbers[i] = state.r[i], numbers[3 + i] = state.v[i];
  numbers[formula::Ephemeris::distance] = distance, numbers[formula::Ephemeris::inverse_distance] = 1.0 / distance;
}

bool Orbit::Path::is_same(const formula::Ephemeris::Path& other) const {
  const auto* path = dynamic_cast<const Path*>(&other);
  return path != nullptr && have_same_bits(given_, path->given_);
}

std::string_view to_text(OrbitKind kind) {
  switch (kind) {
    case OrbitKind::circular: return "circular";
    case OrbitKind::elliptic: return "elliptic";
    case OrbitKind::parabolic: return "parabolic";
    case OrbitKind::hyperbolic: return "hyperbolic";
    case OrbitKind::radial: return "radial";
    case OrbitKind::table: break;
  }
  return "table";
}

Orbit::Orbit(std::shared_ptr<const Path> path) : path_(std::move(path)) {}

Orbit Orbit::from_state(double mu, const Vector3d& r0, const Vector3d& v0, double t0) {
  require_positive("mu", mu);
  for (int i = 0; i < 3; ++i) require_finite("r0", r0[i]), require_finite("v0", v0[i]);
  require_finite("t0", t0);
  if (r0.isZero(0.0)) throw InvalidInput("r0", "not the centre", "0, 0, 0");
  return Orbit(std::make_shared<ConicPath>(mu, r0, v0, t0));
}

Orbit Orbit::from_elements(const OrbitElements& given) {
  require_positive("mu", given.mu);
  if (!(given.e >= 0.0 && std::isfinite(given.e))) throw InvalidInput("e", "at least 0 and finite", to_text(given.e));
  const bool by_axis = !std::isnan(given.semi_major_axis), by_distance = !std::isnan(given.periapsis_distance);
  if (by_axis == by_distance)
    throw InvalidInput("periapsis_distance, a", "one of them", by_axis ? "both" : "neither");
  if (by_axis && given.e >= 1.0)
    throw InvalidInput("a", "left out with e >= 1", to_text(given.semi_major_axis), "give periapsis_distance");
  require_positive(by_axis ? "a" : "periapsis_distance", by_axis ? given.semi_major_axis : given.periapsis_distance);
  for (const auto& [name, value] : {std::pair{"inclination", given.inclination}, std::pair{"node", given.node},
                                    std::pair{"periapsis", given.periapsis}, std::pair{"anomaly", given.anomaly},
                                    std::pair{"t0", given.t0}, std::pair{"j2", given.j2}})
    require_finite(name, value);
  if (given.j2 != 0.0) {
    if (given.e >= 1.0) throw InvalidInput("j2", "left out with e >= 1", to_text(given.j2), "its secular rates are of ellipses");
    require_positive("radius", given.radius);
  }
  return Orbit(std::make_shared<ConicPath>(given));
}

Orbit Orbit::table(std::vector<double> t, std::vector<Vector3d> r, std::vector<Vector3d> v, double mu) {
  return Orbit(std::make_shared<OrbitTable>(OrbitRows{std::move(t), std::move(r), std::move(v), mu}));
}

OrbitState Orbit::at(double t) const { return path_->at(DD(t)); }
OrbitKind Orbit::kind() const { return path_->kind(); }
double Orbit::mu() const { return path_->mu(); }
double Orbit::e() const { return path_->e(); }
double Orbit::period() const { return path_->period(); }
double Orbit::periapsis_distance() const { return path_->periapsis_distance(); }
double Orbit::t0() const { return path_->t0(); }
double Orbit::first_time() const { return path_->first_time(); }
double Orbit::last_time() const { return path_->last_time(); }
const OrbitGiven& Orbit::given() const { return path_->given(); }

formula::Ephemeris Orbit::ephemeris(std::string name) const {
  if (kind() == OrbitKind::table)
    throw InvalidInput("orbit", "a conic where a torque takes it", "a table", "fit elements to the table");
  return formula::Ephemeris(path_, std::move(name));
}

std::optional<Orbit> Orbit::from_ephemeris(const formula::Ephemeris& ephemeris) {
  auto path = std::dynamic_pointer_cast<const Path>(ephemeris.path());
  if (!path) return std::nullopt;
  return Orbit(std::move(path));
}

bool operator==(const Orbit& a, const Orbit& b) { return a.path_ == b.path_ || a.path_->is_same(*b.path_); }

}  // namespace polhode
