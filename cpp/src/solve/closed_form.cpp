#include "polhode/solve/closed_form.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>

#include "polhode/core/error.hpp"
#include "polhode/math/detail/double_double.hpp"
#include "polhode/math/detail/functions.hpp"
#include "solve/distance.hpp"

namespace polhode {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

std::string percent(double part) {
  char text[32];
  std::snprintf(text, sizeof text, part < 1e-3 ? "%.0e" : "%.2g %%", part < 1e-3 ? part : 100 * part);
  return text;
}

std::string degrees(double angle) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g degrees", angle * (180 / std::numbers::pi));
  return text;
}

/// The gravity of a scene in which it is the only torque.
const torques::Gravity* find_only_gravity(const Scene& scene) {
  if (scene.torque_sum().rotors) return nullptr;
  const torques::Gravity* found = nullptr;
  for (const AnyTorque& torque : scene.torques()) {
    if (traits(torque).vanishes) continue;
    const auto* gravity = std::get_if<torques::Gravity>(&torque);
    if (gravity == nullptr || found != nullptr) return nullptr;
    found = gravity;
  }
  return found;
}

/// The symmetry axis of HeavyTop, which requires two moments equal bit for bit. A full tensor has none, because its
/// moments are rounded.
std::optional<int> find_top_axis(const Scene& scene, const Vector3d& arm) {
  const Matrix3d& I = scene.inertia_B().matrix();
  if (!scene.inertia_B().is_diagonal()) return std::nullopt;
  for (const int axis : {2, 0, 1}) {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    if (I(a, a) != I(b, b)) continue;
    if (arm[a] == 0.0 && arm[b] == 0.0) return axis;
    return std::nullopt;   // HeavyTop takes the first equal pair
  }
  return std::nullopt;
}

std::string refuse_free(const Scene& scene, const Facts& facts) {
  if (facts.is_free()) return "";
  std::string names;
  for (const AnyTorque& torque : scene.torques()) {
    if (traits(torque).vanishes) continue;
    if (!names.empty()) names += " and ";
    names += torque_name(torque);
  }
  if (facts.torques.rotors && facts.torques.acting == 1) return "rotors turn with the body";
  if (facts.torques.rotors) names += " and rotors";
  return "not free: " + names + (facts.torques.acting == 1 ? " acts" : " act");
}

std::string refuse_unless(bool holds, const char* why_not) { return holds ? "" : why_not; }

bool is_steady(const Facts& facts) {
  return facts.off_axis == 0.0 || facts.off_axis <= 4 * symmetry_gap;
}

std::string refuse_rest(const Scene& scene, const Facts& facts) {
  std::string torques = refuse_free(scene, facts);
  if (!torques.empty()) return torques;
  return refuse_unless(scene.omega().isZero(0.0), "the body rotates");
}

std::string refuse_spherical(const Scene& scene, const Facts& facts) {
  std::string torques = refuse_free(scene, facts);
  if (!torques.empty()) return torques;
  if (facts.symmetry == Symmetry::spherical) return "";
  return "its moments differ by " + percent(facts.gap_low + facts.gap_high);
}

std::string refuse_steady(const Scene& scene, const Facts& facts) {
  std::string torques = refuse_free(scene, facts);
  if (!torques.empty()) return torques;
  if (is_steady(facts)) return "";
  return "omega is " + degrees(facts.off_axis) + " off the nearest principal axis";
}

std::string refuse_symmetric(const Scene& scene, const Facts& facts) {
  std::string torques = refuse_free(scene, facts);
  if (!torques.empty()) return torques;
  if (facts.symmetry == Symmetry::oblate || facts.symmetry == Symmetry::prolate) return "";
  return "the closest two moments differ by " + percent(std::min(facts.gap_low, facts.gap_high));
}

std::string refuse_separatrix(const Scene& scene, const Facts& facts) {
  std::string torques = refuse_free(scene, facts);
  if (!torques.empty()) return torques;
  if (facts.symmetry != Symmetry::triaxial) return "the body has no intermediate axis";
  if (facts.off_axis == 0.0) return "omega is along a principal axis";
  if (facts.separatrix == 0.0) return "";
  char text[64];
  std::snprintf(text, sizeof text, "k'^2 = %.2g, not exactly 0", facts.separatrix);
  return text;
}

std::string refuse_triaxial(const Scene& scene, const Facts& facts) { return refuse_free(scene, facts); }

std::string refuse_top(const Scene& scene, const Facts& facts) {
  if (facts.is_free()) return "no gravity acts";
  if (facts.torques.rotors) return "rotors turn with the body";
  const torques::Gravity* gravity = find_only_gravity(scene);
  if (gravity == nullptr) return "needs gravity as the only torque";
  if (std::min(facts.gap_low, facts.gap_high) > symmetry_gap) {
    return "the closest two moments differ by " + percent(std::min(facts.gap_low, facts.gap_high));
  }
  return refuse_unless(find_top_axis(scene, gravity->arm()).has_value(),
                       "the centre of mass is off the axis whose other two moments are equal bit for bit");
}

constexpr std::string_view jacobi = "Jacobi 1850; Klein & Sommerfeld 1897-1910 (Cayley-Klein form)";

constexpr ExactModel models[] = {
    {"rest", "no torque and no rotation: the attitude is constant", "Newton's first law", refuse_rest},
    {"spherical", "three equal moments: omega is constant", "Euler 1758", refuse_spherical},
    {"steady", "rotation about a principal axis: omega is constant", "Euler 1758", refuse_steady},
    {"symmetric", "two equal moments: regular precession, by sines and cosines", "Poinsot 1834", refuse_symmetric},
    {"separatrix", "L^2 = 2 T I2 exactly: one flip, by hyperbolic functions", jacobi, refuse_separatrix},
    {"triaxial", "three different moments: elliptic and theta functions", jacobi, refuse_triaxial},
    {"heavy_top", "Lagrange's top: a symmetric body on a pivot on its axis under gravity; theta functions",
     "Klein & Sommerfeld 1897-1910", refuse_top},
};

/// The largest distance of two closed forms at sixteen of the scene's times.
double compare_closed_forms(const Scene& scene, const ClosedForm& a, const ClosedForm& b) {
  constexpr std::size_t most = 16;
  const std::vector<double>& times = scene.times();
  const std::size_t n = std::min(most, times.size());
  double t[most], wa[3 * most], wb[3 * most], qa[4 * most], qb[4 * most];
  // The last time, and evenly spread times before it.
  for (std::size_t i = 0; i < n; ++i) t[i] = times[times.size() - 1 - i * ((times.size() - 1) / n)] - scene.t0();
  a.at(t, n, wa, qa);
  b.at(t, n, wb, qb);
  return compute_distance(n, scene.omega().norm(), wa, qa, wb, qb);
}

constexpr double nudge = 0x1p-46;   // relative change of an input, to measure its effect

}  // namespace

std::string_view ClosedForm::model() const {
  if (std::holds_alternative<HeavyTop>(motion_)) return "heavy_top";
  switch (std::get<FreeMotion>(motion_).kind()) {
    case FreeKind::rest: return "rest";
    case FreeKind::spherical: return "spherical";
    case FreeKind::steady: return "steady";
    case FreeKind::oblate:
    case FreeKind::prolate: return "symmetric";
    case FreeKind::separatrix: return "separatrix";
    case FreeKind::about_least:
    case FreeKind::about_greatest: break;
  }
  return "triaxial";
}

double ClosedForm::rate(const double* omega) const {
  const double w = math::hypot(omega[0], omega[1], omega[2]);
  if (const auto* top = std::get_if<HeavyTop>(&motion_)) {
    return math::hypot(w, std::sqrt(std::abs(top->weight_arm()) / top->inertia().moments()[2]));
  }
  return w;
}

std::span<const ExactModel> exact_models() { return models; }

std::optional<ClosedForm> find_closed_form(const Scene& scene, const Facts& facts) {
  if (facts.is_free()) return ClosedForm(FreeMotion(scene.inertia_B(), scene.omega(), scene.attitude()));
  const torques::Gravity* gravity = find_only_gravity(scene);
  if (gravity == nullptr) return std::nullopt;
  const std::optional<int> axis = find_top_axis(scene, gravity->arm());
  if (!axis) return std::nullopt;
  const double weight_arm = gravity->weight() * gravity->arm()[*axis];
  return ClosedForm(HeavyTop(scene.inertia_B(), weight_arm, scene.omega(), scene.attitude()));
}

double compute_closed_form_error(const Scene& scene, const Facts& facts, const ClosedForm& form) {
  constexpr double u = epsilon / 2;
  double error = 20 * epsilon;
  if (scene.t0() != 0.0) {
    bool rounded = false;
    for (const double t : scene.times()) rounded |= math::two_diff(t, scene.t0()).lo != 0.0;
    if (rounded) error += 2 * std::numbers::pi * facts.turns * u;
  }
  if (const torques::Gravity* gravity = facts.is_free() ? nullptr : find_only_gravity(scene)) {
    const double arm = gravity->arm()[*find_top_axis(scene, gravity->arm())];
    const double product = gravity->weight() * arm;
    if (std::fma(gravity->weight(), arm, -product) != 0.0) {
      const HeavyTop other(scene.inertia_B(), product * (1 + nudge), scene.omega(), scene.attitude());
      error += 4 * (u / nudge) * compare_closed_forms(scene, form, ClosedForm(other));
    }
  } else if (!scene.inertia_B().is_diagonal() && !scene.omega().isZero(0.0)) {
    // The principal moments and axes of a full tensor have errors of a few units of rounding of the largest moment.
    const PrincipalAxes& principal = scene.inertia_B().principal();
    const double largest = principal.moments[2];
    const auto perturbed = [&](double sign) {
      const Vector3d I = principal.moments + sign * nudge * largest * Vector3d{1, -1, 1};
      const Vector3d w = principal.axes.transpose() * scene.omega();
      return ClosedForm(FreeMotion(InertiaTensor::from_moments(I, false), w));
    };
    error += 8 * (epsilon / nudge) * compare_closed_forms(scene, perturbed(1), perturbed(-1));
  }
  return error;
}

}  // namespace polhode
