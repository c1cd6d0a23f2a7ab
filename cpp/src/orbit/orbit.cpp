#include "polhode/orbit/orbit.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <numbers>
#include <utility>

#include "orbit/conic_path.hpp"
#include "orbit/path.hpp"
#include "polhode/core/error.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode {
namespace {

using math::DD;

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
    if (given.e >= 1.0)
      throw InvalidInput("j2", "left out with e >= 1", to_text(given.j2), "its secular rates are of ellipses");
    require_positive("radius", given.radius);
    const double least = by_axis ? given.semi_major_axis * (1.0 - given.e) : given.periapsis_distance;
    if (given.radius > least)
      throw InvalidInput("radius", "at most the periapsis distance, " + to_text(least), to_text(given.radius),
                         "the orbit goes through the planet");
  }
  return Orbit(std::make_shared<ConicPath>(given));
}

Orbit Orbit::table(std::vector<double> t, std::vector<Vector3d> r, std::vector<Vector3d> v, double mu) {
  return Orbit(std::make_shared<OrbitTable>(OrbitRows{std::move(t), std::move(r), std::move(v), mu}));
}

OrbitState Orbit::at(double t) const { return path_->at(DD(t)); }
std::vector<Eclipse> Orbit::find_eclipses(const Vector3d& sun, double radius, double first, double last) const {
  const double length = sun.stableNorm();
  if (!(length > 0.0 && std::isfinite(length)))
    throw InvalidInput("sun", "finite and not 0", length == 0.0 ? "0, 0, 0" : to_text(length));
  require_positive("shadow", radius);
  require_finite("begin", first), require_finite("end", last);
  if (!(first <= last)) throw InvalidInput("end", "at or after the begin, " + to_text(first), to_text(last));
  return path_->find_eclipses(sun, radius, first, last);
}

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
