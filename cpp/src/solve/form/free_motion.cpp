#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "polhode/exact/free_motion.hpp"
#include "polhode/math/detail/functions.hpp"
#include "solve/form/forms.hpp"
#include "solve/form/input_error.hpp"
#include "solve/form/parts.hpp"

// The free body: one closed form, named by the six kinds of its motion.
namespace polhode::form {
namespace {

bool is_steady(const Facts& facts) { return facts.off_axis == 0.0 || facts.off_axis <= 4 * symmetry_gap; }

Refusal refuse_rest(const Scene& scene, const Facts& facts, Words words) {
  if (Refusal torques = refuse_torques(scene, facts, words)) return torques;
  return scene.omega().isZero(0.0) ? holds() : refuse(words, "the body rotates");
}

Refusal refuse_spherical(const Scene& scene, const Facts& facts, Words words) {
  if (Refusal torques = refuse_torques(scene, facts, words)) return torques;
  if (facts.symmetry == Symmetry::spherical) return holds();
  return refuse(words, [&] { return "its moments differ by " + to_percent(facts.gap_low + facts.gap_high); });
}

Refusal refuse_steady(const Scene& scene, const Facts& facts, Words words) {
  if (Refusal torques = refuse_torques(scene, facts, words)) return torques;
  if (is_steady(facts)) return holds();
  return refuse(words, [&] {
    char text[64];
    std::snprintf(text, sizeof text, "omega is %.2g degrees off the nearest principal axis",
                  facts.off_axis * (180 / std::numbers::pi));
    return std::string(text);
  });
}

Refusal refuse_symmetric(const Scene& scene, const Facts& facts, Words words) {
  if (Refusal torques = refuse_torques(scene, facts, words)) return torques;
  if (facts.symmetry == Symmetry::oblate || facts.symmetry == Symmetry::prolate) return holds();
  return refuse(words, [&] {
    return "the closest two moments differ by " + to_percent(std::min(facts.gap_low, facts.gap_high));
  });
}

Refusal refuse_separatrix(const Scene& scene, const Facts& facts, Words words) {
  if (Refusal torques = refuse_torques(scene, facts, words)) return torques;
  if (facts.symmetry != Symmetry::triaxial) return refuse(words, "the body has no intermediate axis");
  if (facts.off_axis == 0.0) return refuse(words, "omega is along a principal axis");
  if (facts.separatrix == 0.0) return holds();
  return refuse(words, [&] {
    char text[64];
    std::snprintf(text, sizeof text, "k'^2 = %.2g, not exactly 0", facts.separatrix);
    return std::string(text);
  });
}

/// The record of a kind. A body next to the border of two kinds belongs to the one that FreeMotion takes.
const ClosedFormRecord& get_record(FreeKind kind) {
  switch (kind) {
    case FreeKind::rest: return rest_form;
    case FreeKind::spherical: return spherical_form;
    case FreeKind::steady: return steady_form;
    case FreeKind::oblate:
    case FreeKind::prolate: return symmetric_form;
    case FreeKind::separatrix: return separatrix_form;
    case FreeKind::about_least:
    case FreeKind::about_greatest: break;
  }
  return triaxial_form;
}

class FreeForm final : public ClosedFormOf<FreeMotion> {
 public:
  explicit FreeForm(FreeMotion motion) : ClosedFormOf(get_record(motion.kind()), std::move(motion)) {}

  double rate(const double* omega) const override { return math::hypot(omega[0], omega[1], omega[2]); }

  double measure_error(const Scene& scene, const Facts& facts) const override {
    return evaluation_error + measure_times(scene, facts) + measure_inertia(scene, [&](double sign) {
             return FreeMotion(nudge_moments(scene, sign), to_principal(scene, scene.omega()));
           });
  }
};

std::unique_ptr<const ClosedForm> make_free(const Scene& scene, const Facts&) {
  return std::make_unique<FreeForm>(FreeMotion(scene.inertia_B(), scene.omega(), scene.attitude()));
}

int count_free_set_ups(const Scene& scene, const Facts&) { return inertia_is_rounded(scene) ? 2 : 0; }

constexpr std::string_view jacobi = "Jacobi 1850; Klein & Sommerfeld 1897-1910 (Cayley-Klein form)";

constexpr ClosedFormRecord describe_free(
    std::string_view name, std::string_view doc, std::string_view source,
    Refusal (*refuse)(const Scene&, const Facts&, Words), std::string (*explain)(const Scene&, const Facts&)) {
  return {.name = name,
          .type = "FreeMotion",
          .doc = doc,
          .source = source,
          .set_up_seconds = 1.5e-6,
          .sample_seconds = 8e-9,
          .refuse = refuse,
          .make = make_free,
          .explain = explain,
          .count_error_set_ups = count_free_set_ups};
}

}  // namespace

constinit const ClosedFormRecord rest_form =
    describe_free("rest", "no torque and no rotation: the attitude is constant", "Newton's first law", refuse_rest,
                  [](const Scene&, const Facts&) -> std::string {
                    return "The body does not rotate and no torque acts: every sample equals the start.";
                  });
constinit const ClosedFormRecord spherical_form = describe_free(
    "spherical", "three equal moments: omega is constant", "Euler 1758", refuse_spherical,
    [](const Scene&, const Facts&) -> std::string { return "All moments are equal and no torque acts: omega is constant."; });
constinit const ClosedFormRecord steady_form = describe_free(
    "steady", "rotation about a principal axis: omega is constant", "Euler 1758", refuse_steady,
    [](const Scene&, const Facts&) -> std::string {
      return "The body rotates about a principal axis and no torque acts: omega is constant, even if the rotation is "
             "unstable.";
    });
constinit const ClosedFormRecord symmetric_form = describe_free(
    "symmetric", "two equal moments: regular precession, by sines and cosines", "Poinsot 1834", refuse_symmetric,
    [](const Scene&, const Facts&) -> std::string {
      return "Two moments are equal and no torque acts: the motion is a regular precession, two rotations at constant "
             "rates.";
    });
constinit const ClosedFormRecord separatrix_form = describe_free(
    "separatrix", "L^2 = 2 T I2 exactly: one flip, by hyperbolic functions", jacobi, refuse_separatrix,
    [](const Scene&, const Facts&) -> std::string {
      return "The start is exactly on the separatrix: the body flips once, described by hyperbolic functions.";
    });
constinit const ClosedFormRecord triaxial_form = describe_free(
    "triaxial", "three different moments: elliptic and theta functions", jacobi, refuse_torques,
    [](const Scene&, const Facts& facts) -> std::string {
      const char* text = "No torque acts: theta functions give each sample directly, without steps.";
      if (!(facts.separatrix < 1e-3)) return text;
      char near[160];
      std::snprintf(near, sizeof near,
                    " The start is close to the separatrix (k'^2 = %.1e). An integration loses digits at each flip, a "
                    "closed form does not.",
                    facts.separatrix);
      return text + std::string(near);
    });

}  // namespace polhode::form
