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
#include "solve/proportional_damping.hpp"

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

std::string list_torques(const Scene& scene, const Facts& facts) {
  std::string names;
  for (const AnyTorque& torque : scene.torques()) {
    if (traits(torque).vanishes) continue;
    if (!names.empty()) names += " and ";
    names += torque_name(torque);
  }
  if (facts.torques.rotors) names += names.empty() ? "rotors" : " and rotors";
  return names + (facts.torques.acting == 1 && !facts.torques.rotors ? " acts" : " act");
}

std::string refuse_free(const Scene& scene, const Facts& facts) {
  return facts.is_free() ? "" : "not free: " + list_torques(scene, facts);
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

bool only_damps(const Scene& scene) {
  return std::all_of(scene.torques().begin(), scene.torques().end(), [](const AnyTorque& torque) {
    return traits(torque).vanishes || std::holds_alternative<torques::Damping>(torque) ||
           std::holds_alternative<torques::AngularDamping>(torque);
  });
}

std::string refuse_damped(const Scene& scene, const Facts& facts) {
  if (facts.is_free()) return "no torque damps";
  if (!only_damps(scene)) return "needs damping alone: " + list_torques(scene, facts);
  return refuse_unless(find_proportional_damping(scene).has_value(),
                       "the damping matrix is no multiple of the inertia to the last bit");
}

std::string refuse_pendulum(const Scene& scene, const Facts& facts) {
  if (facts.is_free()) return "no gravity acts";
  const torques::Gravity* gravity = find_only_gravity(scene);
  if (gravity == nullptr) return "needs gravity as the only torque";
  return Pendulum::refuse(scene.inertia_B(), gravity->weight(), gravity->arm(), scene.omega(), scene.attitude());
}

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
    {"damped_free", "damping proportional to the angular momentum, -c I omega: the free motion in slowed time",
     "a change of time in Euler's equations", refuse_damped},
    {"pendulum", "the plane pendulum: any body that swings about a horizontal body axis; Jacobi's elliptic functions",
     "Whittaker 1937, Analytical Dynamics, sec. 44", refuse_pendulum},
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
constexpr double unit = epsilon / 2;

/// The effect of the rounding of weight times arm.
double measure_rounded_weight(const Scene& scene, const torques::Gravity& gravity, const ClosedForm& form) {
  const double arm = gravity.arm()[*find_top_axis(scene, gravity.arm())], product = gravity.weight() * arm;
  if (std::fma(gravity.weight(), arm, -product) == 0.0) return 0.0;
  const HeavyTop other(scene.inertia_B(), product * (1 + nudge), scene.omega(), scene.attitude());
  return 4 * (unit / nudge) * compare_closed_forms(scene, form, ClosedForm(other));
}

/// The change of a damped motion when the times change by a part of themselves, in units of this part.
double measure_damped_span(const Scene& scene, const Facts& facts, double rate) {
  const DampedFree motion(scene.inertia_B(), rate, scene.omega());
  const double slowed = std::max(motion.slowed_time(facts.after), -motion.slowed_time(-facts.before));
  const double grown = std::abs(rate) * facts.span();
  return scene.omega().norm() * slowed * (1 + grown) + grown;
}

}  // namespace

std::string_view ClosedForm::model() const {
  if (std::holds_alternative<HeavyTop>(motion_)) return "heavy_top";
  if (std::holds_alternative<DampedFree>(motion_)) return "damped_free";
  if (std::holds_alternative<Pendulum>(motion_)) return "pendulum";
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
  if (const auto* pendulum = std::get_if<Pendulum>(&motion_)) return math::hypot(w, pendulum->frequency());
  if (const auto* damped = std::get_if<DampedFree>(&motion_)) {
    // Where omega grows, at |c|; a body far slower than at the start is not worth short steps.
    const double start = damped->omega().norm();
    return w > 0.0 ? w + std::abs(damped->damping()) * (w / (w + start)) : 0.0;
  }
  return w;
}

std::span<const ExactModel> exact_models() { return models; }

std::string explain_no_closed_form(const Scene& scene, const Facts& facts) {
  if (only_damps(scene)) return refuse_damped(scene, facts);
  const std::string top = refuse_top(scene, facts);
  return find_only_gravity(scene) == nullptr ? top : top + ". No pendulum: " + refuse_pendulum(scene, facts);
}

std::optional<ClosedForm> find_closed_form(const Scene& scene, const Facts& facts) {
  if (facts.is_free()) return ClosedForm(FreeMotion(scene.inertia_B(), scene.omega(), scene.attitude()));
  if (const auto damping = find_proportional_damping(scene))
    return ClosedForm(DampedFree(scene.inertia_B(), damping->rate, scene.omega(), scene.attitude()));
  const torques::Gravity* gravity = find_only_gravity(scene);
  if (gravity == nullptr) return std::nullopt;
  if (refuse_pendulum(scene, facts).empty())
    return ClosedForm(
        Pendulum(scene.inertia_B(), gravity->weight(), gravity->arm(), scene.omega(), scene.attitude()));
  const std::optional<int> axis = find_top_axis(scene, gravity->arm());
  if (!axis) return std::nullopt;
  const double weight_arm = gravity->weight() * gravity->arm()[*axis];
  return ClosedForm(HeavyTop(scene.inertia_B(), weight_arm, scene.omega(), scene.attitude()));
}

double compute_closed_form_error(const Scene& scene, const Facts& facts, const ClosedForm& form) {
  double error = 20 * epsilon;
  const bool free = facts.is_free();
  const std::optional<ProportionalDamping> damping = free ? std::nullopt : find_proportional_damping(scene);
  if (scene.t0() != 0.0) {
    bool rounded = false;
    for (const double t : scene.times()) rounded |= math::two_diff(t, scene.t0()).lo != 0.0;
    if (rounded) error += unit * (damping ? measure_damped_span(scene, facts, damping->rate)
                                          : 2 * std::numbers::pi * facts.turns);
  }
  const torques::Gravity* gravity = free || damping ? nullptr : find_only_gravity(scene);
  if (form.model() == "pendulum") return error;   // the product of weight and arm is a double-double there
  if (gravity != nullptr) return error + measure_rounded_weight(scene, *gravity, form);
  const auto make = [&](const InertiaTensor& inertia, const Vector3d& omega) {
    return damping ? ClosedForm(DampedFree(inertia, damping->rate, omega)) : ClosedForm(FreeMotion(inertia, omega));
  };
  const Vector3d signs{1, -1, 1};
  if (damping && damping->rounded) {
    // Together all torques differ from -c I omega by half a unit of the momentum that they take away.
    const auto kicked = [&](double sign) {
      return make(scene.inertia_B(), scene.omega().cwiseProduct(Vector3d::Ones() + sign * nudge * signs));
    };
    error += 2 * (unit / nudge) * compare_closed_forms(scene, kicked(1), kicked(-1));
  }
  if (!scene.inertia_B().is_diagonal() && !scene.omega().isZero(0.0)) {
    // The principal moments and axes of a full tensor have errors of a few units of rounding of the largest moment.
    const PrincipalAxes& principal = scene.inertia_B().principal();
    const double largest = principal.moments[2];
    const auto perturbed = [&](double sign) {
      const Vector3d I = principal.moments + sign * nudge * largest * signs;
      return make(InertiaTensor::from_moments(I, false), principal.axes.transpose() * scene.omega());
    };
    error += 8 * (epsilon / nudge) * compare_closed_forms(scene, perturbed(1), perturbed(-1));
  }
  return error;
}

}  // namespace polhode
