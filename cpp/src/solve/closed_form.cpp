#include "polhode/solve/closed_form.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "polhode/math/detail/functions.hpp"
#include "solve/closed_form_parts.hpp"
#include "solve/proportional_damping.hpp"

namespace polhode {
namespace {

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

std::string refuse_gyrostat(const Scene& scene, const Facts& facts) {
  if (!facts.torques.rotors) return "no rotor turns";
  return facts.torques.acting == 1 ? "" : "not free: " + list_torques(scene, facts);
}

std::string refuse_damped(const Scene& scene, const Facts& facts) {
  if (facts.is_free()) return "no torque damps";
  if (facts.torques.rotors) return "rotors keep their momentum, which such damping would reduce too";
  if (!only_damps(scene)) return "needs damping alone: " + list_torques(scene, facts);
  return refuse_unless(find_proportional_damping(scene).has_value(),
                       "the damping matrix is no multiple of the inertia to the last bit");
}

std::string refuse_pendulum(const Scene& scene, const Facts& facts) {
  if (facts.is_free()) return "no gravity acts";
  const torques::Gravity* gravity = find_only_gravity(scene);
  if (gravity == nullptr) return "needs gravity as the only torque";
  std::string why_not =
      Pendulum::refuse(scene.inertia_B(), gravity->weight(), gravity->arm(), scene.omega(), scene.attitude());
  if (!why_not.empty() || !facts.torques.rotors) return why_not;
  if (has_carrier(scene)) return "free rotors reduce the inertia, by a rounded amount";
  const Vector3d axis =
      Pendulum(scene.inertia_B(), gravity->weight(), gravity->arm(), scene.omega(), scene.attitude()).axis();
  Eigen::Index along = 0;   // it is a body axis
  axis.cwiseAbs().maxCoeff(&along);
  return refuse_unless(is_along(facts.rotor_momentum, static_cast<int>(along)),
                       "the rotors' momentum is not along the axis of rotation");
}

/// What both tops require.
std::string refuse_symmetric_top(const Scene& scene, const Facts& facts) {
  const torques::Gravity* gravity = find_only_gravity(scene);
  if (gravity == nullptr) return "needs gravity as the only torque";
  if (std::min(facts.gap_low, facts.gap_high) > symmetry_gap) {
    return "the closest two moments differ by " + percent(std::min(facts.gap_low, facts.gap_high));
  }
  return refuse_unless(find_top_axis(scene, gravity->arm()).has_value(),
                       "the centre of mass is off the axis whose other two moments are equal bit for bit");
}

std::string refuse_top(const Scene& scene, const Facts& facts) {
  if (facts.is_free()) return "no gravity acts";
  return facts.torques.rotors ? "rotors turn with the body" : refuse_symmetric_top(scene, facts);
}

std::string refuse_heavy_gyrostat(const Scene& scene, const Facts& facts) {
  if (!facts.torques.rotors) return "no rotor turns";
  if (facts.torques.acting == 1) return "no gravity acts";
  std::string why_not = refuse_symmetric_top(scene, facts);
  if (!why_not.empty()) return why_not;
  const int axis = *find_top_axis(scene, find_only_gravity(scene)->arm());
  return refuse_unless(is_along(facts.rotor_momentum, axis), "the rotors' momentum is not along the axis of symmetry");
}

constexpr std::string_view jacobi = "Jacobi 1850; Klein & Sommerfeld 1897-1910 (Cayley-Klein form)";

constexpr ExactModel models[] = {
    {"rest", "no torque and no rotation: the attitude is constant", "Newton's first law", refuse_rest},
    {"spherical", "three equal moments: omega is constant", "Euler 1758", refuse_spherical},
    {"steady", "rotation about a principal axis: omega is constant", "Euler 1758", refuse_steady},
    {"symmetric", "two equal moments: regular precession, by sines and cosines", "Poinsot 1834", refuse_symmetric},
    {"separatrix", "L^2 = 2 T I2 exactly: one flip, by hyperbolic functions", jacobi, refuse_separatrix},
    {"triaxial", "three different moments: elliptic and theta functions", jacobi, refuse_triaxial},
    {"gyrostat", "a free body with rotors: one theta series for every regime",
     "Zhukovsky 1885; Volterra 1899, Acta Math. 22; Wittenburg 1977", refuse_gyrostat},
    {"damped_free", "damping proportional to the angular momentum, -c I omega: the free motion in slowed time",
     "a change of time in Euler's equations", refuse_damped},
    {"pendulum", "the plane pendulum: any body that swings about a horizontal body axis; Jacobi's elliptic functions",
     "Whittaker 1937, Analytical Dynamics, sec. 44", refuse_pendulum},
    {"heavy_top", "Lagrange's top: a symmetric body on a pivot on its axis under gravity; theta functions",
     "Klein & Sommerfeld 1897-1910", refuse_top},
    {"heavy_gyrostat", "Lagrange's top with a rotor on its axis, as a toy gyroscope: the top in turning axes",
     "Klein & Sommerfeld 1897-1910; Wittenburg 1977", refuse_heavy_gyrostat},
};

}  // namespace

std::string_view ClosedForm::model() const {
  if (const auto* top = std::get_if<HeavyTop>(&motion_)) return top->rotor() == 0.0 ? "heavy_top" : "heavy_gyrostat";
  if (std::holds_alternative<Gyrostat>(motion_)) return "gyrostat";
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
    const Vector3d& moments = top->inertia().moments();
    return math::hypot(w, std::sqrt(std::abs(top->weight_arm()) / moments[2]), top->rotor() / moments[0]);
  }
  if (const auto* gyrostat = std::get_if<Gyrostat>(&motion_))
    return w > 0.0 ? math::hypot(w, compute_nutation_rate(gyrostat->inertia(), gyrostat->momentum())) : 0.0;
  if (const auto* pendulum = std::get_if<Pendulum>(&motion_)) return math::hypot(w, pendulum->frequency());
  if (const auto* damped = std::get_if<DampedFree>(&motion_)) {
    // Where omega grows, at |c|; a body far slower than at the start is not worth short steps.
    const double start = damped->omega().norm();
    return w > 0.0 ? w + std::abs(damped->damping()) * (w / (w + start)) : 0.0;
  }
  return w;
}

double ClosedForm::swing_frequency() const {
  if (const auto* pendulum = std::get_if<Pendulum>(&motion_)) return pendulum->frequency();
  const auto* top = std::get_if<HeavyTop>(&motion_);
  if (top == nullptr) return 0.0;
  return std::sqrt(std::abs(top->weight_arm()) / top->inertia().moments()[1]);   // the middle one is of the equal pair
}

std::optional<Vector3d> ClosedForm::swing_axis() const {
  const auto* pendulum = std::get_if<Pendulum>(&motion_);
  return pendulum != nullptr ? std::optional(pendulum->axis()) : std::nullopt;
}

std::span<const ExactModel> exact_models() { return models; }

std::string explain_no_closed_form(const Scene& scene, const Facts& facts) {
  if (only_damps(scene)) return refuse_damped(scene, facts);
  std::string top = facts.torques.rotors ? refuse_heavy_gyrostat(scene, facts) : refuse_top(scene, facts);
  return find_only_gravity(scene) == nullptr ? top : top + ". No pendulum: " + refuse_pendulum(scene, facts);
}

bool is_gyrostat(const Facts& facts) { return facts.torques.rotors && facts.torques.acting == 1; }

std::optional<ClosedForm> find_closed_form(const Scene& scene, const Facts& facts) {
  const InertiaTensor& inertia = scene.inertia_B();
  const Vector3d& h = facts.rotor_momentum;
  if (facts.is_free()) return ClosedForm(FreeMotion(inertia, scene.omega(), scene.attitude()));
  if (is_gyrostat(facts)) return ClosedForm(Gyrostat(inertia, h, scene.omega(), scene.attitude()));
  const auto damping = facts.torques.rotors ? std::nullopt : find_proportional_damping(scene);
  if (damping) return ClosedForm(DampedFree(inertia, damping->rate, scene.omega(), scene.attitude()));
  const torques::Gravity* gravity = find_only_gravity(scene);
  if (gravity == nullptr) return std::nullopt;
  if (refuse_pendulum(scene, facts).empty())
    return ClosedForm(Pendulum(inertia, gravity->weight(), gravity->arm(), scene.omega(), scene.attitude()));
  const std::optional<int> axis = find_top_axis(scene, gravity->arm());
  if (!axis || (facts.torques.rotors && !is_along(h, *axis))) return std::nullopt;
  const double weight_arm = gravity->weight() * gravity->arm()[*axis];
  const double rotor = facts.torques.rotors ? h[*axis] : 0.0;
  return ClosedForm(HeavyTop(inertia, weight_arm, scene.omega(), scene.attitude(), rotor));
}

}  // namespace polhode
