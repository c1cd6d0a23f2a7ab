#include "polhode/solve/effect.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "polhode/core/error.hpp"
#include "solve/effect/bound.hpp"
#include "solve/effect/theorems.hpp"
#include "solve/ground/formulas.hpp"

namespace polhode {
namespace effect {
namespace {

Effect refuse(std::string why) { return {HUGE_VAL, HUGE_VAL, HUGE_VAL, HUGE_VAL, std::move(why)}; }

/// The spans after and before t0 [s].
std::array<double, 2> find_spans(const Scene& scene) {
  const auto [first, last] = std::minmax_element(scene.times().begin(), scene.times().end());
  return {std::max(0.0, *last - scene.t0()), std::max(0.0, scene.t0() - *first)};
}

/// Principal axes with ascending moments, and omega in them.
struct Principal {
  Matrix3d axes;
  Vector3d moments, omega;
};
Principal find_principal(const Scene& scene) {
  const InertiaTensor& J = scene.inertia_B();
  if (!J.is_diagonal()) return {J.axes(), J.moments(), J.axes().transpose() * scene.omega()};
  const Vector3d given = J.matrix().diagonal();   // not rounded
  std::array<int, 3> order{0, 1, 2};
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return given[a] < given[b]; });
  Principal found{Matrix3d::Zero(), {}, {}};
  for (int k = 0; k < 3; ++k) {
    const int i = order[static_cast<std::size_t>(k)];
    found.axes(i, k) = 1.0, found.moments[k] = given[i], found.omega[k] = scene.omega()[i];
  }
  if (found.axes.determinant() < 0.0) found.axes.col(0) *= -1.0, found.omega[0] = -found.omega[0];
  return found;
}

/// The part of the largest rate by which a formula's rates may differ from those of the free body.
constexpr double formula_margin = 0.01;

/// Adds the bounds of one direction of time.
struct Direction {
  Bounds bounds;
  std::vector<double> first_rates, first_rotations;
};

/// The bound without columns, if it is small enough. Windows count as open.
bool bound_crudely(const FreeBody& free, const std::vector<TorqueSize>& sizes, double span, double most_margin,
                   double enough, Direction& found) {
  constexpr double most_growth = 4.0, margin = 1e-3;   // of the rates
  if (!(enough > 0.0 && free.rate_growth * span <= most_growth)) return false;
  double whole = 0.0;
  std::vector<double> parts;
  for (const TorqueSize& size : sizes) {
    parts.push_back(size.fixed + (1.0 + margin) * size.per_rate * free.most_rate);
    whole += parts.back();
  }
  const Bounds bounds = bound_by_growth(free, whole, span);
  const double rate = free.w.norm();
  if (!bounds.refusal.empty() || !(bounds.rate <= std::min({enough, margin, most_margin / rate}) * rate)) return false;
  if (!(bounds.rotation <= enough)) return false;
  found.bounds = bounds;
  for (const double part : parts) {
    found.first_rates.push_back(part * span / free.least);
    found.first_rotations.push_back(0.5 * part * span * span / free.least);
  }
  return true;
}

Direction bound_direction(const Principal& body, const std::vector<TorqueSize>& sizes, double t0, double span,
                          int direction, double most_margin, double enough) {
  // Backwards the body moves as forwards from the opposite rates.
  const FreeBody free(body.moments, direction * body.omega);
  Direction found;
  if (bound_crudely(free, sizes, span, most_margin, enough, found)) return found;
  const FreeTable table(free, span);
  if (!table.refusal().empty()) {
    found.bounds.refusal = table.refusal();
    return found;
  }
  Share all;
  for (const TorqueSize& size : sizes) {
    const Share share = integrate(table, size, body.axes, t0, direction);
    all.fixed += share.fixed, all.per_rate += share.per_rate;
    found.first_rates.push_back(share.fixed.first_rate);
    found.first_rotations.push_back(share.fixed.first_rotation);
  }
  found.bounds = bound_by_tube(table, all, most_margin);
  // The second order costs more sums, and is smaller only where the tube is wide.
  constexpr double narrow = 1.1;
  if (found.bounds.rate <= narrow * all.fixed.rate && found.bounds.rotation <= narrow * all.fixed.rotation)
    return found;
  const Bounds other = bound_by_majorant(table, all, most_margin);
  if (!other.refusal.empty()) return found;
  found.bounds.rate = std::min(found.bounds.rate, other.rate);
  found.bounds.rotation = std::min(found.bounds.rotation, other.rotation);
  if (found.bounds.rotation < HUGE_VAL) found.bounds.refusal.clear();
  return found;
}

}  // namespace

Together bound_together(const Scene& scene, std::span<const std::size_t> torques, double enough) {
  Together found;
  found.omega.assign(torques.size(), 0.0), found.attitude.assign(torques.size(), 0.0);
  const auto refuse_all = [&](std::string why) {
    found.all = refuse(std::move(why));
    return found;
  };
  // Units of powers of two near the body's own, so that no square leaves the range of float64.
  Principal body = find_principal(scene);
  if (body.omega.isZero(0.0)) return refuse_all("the body is at rest without the torque");
  const int moment_unit = std::ilogb(body.moments[2]), rate_unit = std::ilogb(body.omega.cwiseAbs().maxCoeff());
  for (double& moment : body.moments) moment = std::ldexp(moment, -moment_unit);
  for (double& rate : body.omega) rate = std::ldexp(rate, -rate_unit);
  auto spans = find_spans(scene);
  Region region{.inertia_B = scene.inertia_B().matrix(), .gap = 0.0, .begin = scene.t0() - spans[1],
                .end = scene.t0() + spans[0], .most_rates_B = Vector3d::Zero(), .margin = 0.0};
  for (double& span : spans) span = std::ldexp(span, rate_unit);
  const double t0 = std::ldexp(scene.t0(), rate_unit);
  const Vector3d& J = body.moments;
  region.gap = std::ldexp(J[2] - J[0], moment_unit);
  const Vector3d momentum = J.cwiseProduct(body.omega);
  const double twice_T = momentum.dot(body.omega), L = momentum.norm();
  Vector3d most_rates;
  for (int k = 0; k < 3; ++k) most_rates[k] = std::ldexp(std::min(std::sqrt(twice_T / J[k]), L / J[k]), rate_unit);
  region.most_rates_B = body.axes.cwiseAbs() * most_rates;
  region.margin = formula_margin * most_rates.stableNorm();

  std::vector<TorqueSize> sizes;
  bool all_zero = true;
  double impulse = 0.0, most_margin = HUGE_VAL;
  for (const std::size_t number : torques) {
    TorqueSize size = find_size(scene.torques()[number], region);
    if (!size.refusal.empty()) return refuse_all(size.refusal);
    size = scale(std::move(size), moment_unit, rate_unit);
    all_zero = all_zero && size.is_zero();
    const double longest = std::max(spans[0], spans[1]);
    if (size.windows.empty()) impulse += (size.fixed + size.per_rate * body.omega.norm()) * longest;
    // A formula's size holds in its region alone.
    if (size.per_rate == 0.0 && traits(scene.torques()[number]).uses_rates)
      most_margin = std::ldexp(region.margin, -rate_unit);
    sizes.push_back(std::move(size));
  }
  if (all_zero) return found;
  if (!(impulse <= 0.1 * L)) return refuse_all("the torque may change the angular momentum by more than a tenth");

  std::vector<double> rates(sizes.size(), 0.0), rotations(sizes.size(), 0.0);
  for (const int direction : {1, -1}) {
    const double span = spans[direction > 0 ? 0 : 1];
    if (span == 0.0) continue;
    const Direction one = bound_direction(body, sizes, t0, span, direction, most_margin, enough);
    if (!one.bounds.refusal.empty()) return refuse_all(one.bounds.refusal);
    Effect& all = found.all;
    all.omega = std::max(all.omega, one.bounds.rate), all.attitude = std::max(all.attitude, one.bounds.rotation);
    const double first_rate = std::accumulate(one.first_rates.begin(), one.first_rates.end(), 0.0);
    const double first_rotation = std::accumulate(one.first_rotations.begin(), one.first_rotations.end(), 0.0);
    all.first_omega = std::max(all.first_omega, first_rate);
    all.first_attitude = std::max(all.first_attitude, first_rotation);
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      rates[i] = std::max(rates[i], one.first_rates[i]);
      rotations[i] = std::max(rotations[i], one.first_rotations[i]);
    }
  }
  found.all.omega = std::ldexp(found.all.omega, rate_unit);
  found.all.first_omega = std::ldexp(found.all.first_omega, rate_unit);
  if (!(found.all.omega < HUGE_VAL && found.all.attitude < HUGE_VAL)) return refuse_all("no bound is finite");
  const double sum_rates = std::accumulate(rates.begin(), rates.end(), 0.0);
  const double sum_rotations = std::accumulate(rotations.begin(), rotations.end(), 0.0);
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (sum_rates > 0.0) found.omega[i] = found.all.omega * (rates[i] / sum_rates);
    if (sum_rotations > 0.0) found.attitude[i] = found.all.attitude * (rotations[i] / sum_rotations);
  }
  return found;
}

}  // namespace effect

Effect compute_effect(const Scene& scene, std::size_t torque) {
  const std::vector<AnyTorque>& torques = scene.torques();
  if (torque >= torques.size()) {
    throw InvalidInput("torque", "the number of one of " + std::to_string(torques.size()) + " torques",
                       std::to_string(torque));
  }
  if (traits(torques[torque]).vanishes) return {};
  for (std::size_t i = 0; i < torques.size(); ++i) {
    if (i != torque && !traits(torques[i]).vanishes)
      return effect::refuse("what remains is not a free body: " + std::string(torque_name(torques[i])) + " acts");
  }
  if (!scene.rotors().empty()) return effect::refuse("what remains is not a free body: rotors act");
  if (scene.changes()) return effect::refuse("what remains is not a free body: the body changes");
  // A formula may be one or several torques of the list.
  const Scene alone = resolve_formulas(scene.with_torques({torques[torque]}), AsCustom::no);
  std::vector<std::size_t> parts(alone.torques().size());
  std::iota(parts.begin(), parts.end(), std::size_t{0});
  return effect::bound_together(alone, parts).all;
}

}  // namespace polhode
