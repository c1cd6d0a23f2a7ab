#include <algorithm>
#include <cmath>
#include <cstdio>

#include "polhode/exact/damped_free.hpp"
#include "polhode/math/detail/functions.hpp"
#include "solve/form/forms.hpp"
#include "solve/form/input_error.hpp"
#include "solve/form/parts.hpp"
#include "solve/ground/proportional_damping.hpp"

// A free body with damping proportional to its angular momentum.
namespace polhode::form {
namespace {

Refusal refuse_damped(const Scene& scene, const Facts& facts, Words words) {
  if (facts.is_free()) return refuse(words, "no torque damps");
  if (facts.torques.rotors) return refuse(words, "rotors keep their momentum, which such damping would reduce too");
  if (!only_damps(scene))
    return refuse(words, [&] { return "needs damping alone: " + list_torques(scene, facts); });
  if (find_proportional_damping(scene)) return holds();
  return refuse(words, "the damping matrix is no multiple of the inertia to the last bit");
}

class DampedForm final : public ClosedFormOf<DampedFree> {
 public:
  using ClosedFormOf::ClosedFormOf;

  double rate(const double* omega) const override {
    const double w = math::hypot(omega[0], omega[1], omega[2]), start = motion().omega().norm();
    // Where omega grows, at |c|; a body far slower than at the start needs no short steps.
    return w > 0.0 ? w + std::abs(motion().damping()) * (w / (w + start)) : 0.0;
  }

  double measure_error(const Scene& scene, const Facts& facts) const override {
    const double c = motion().damping();
    double error = evaluation_error;
    if (times_are_rounded(scene)) error += unit_roundoff * measure_span(scene, facts);
    if (find_proportional_damping(scene)->rounded) {
      // Together all torques differ from -c I omega by half a unit of the momentum that they take.
      const auto perturbed = [&](double sign) {
        return DampedFree(scene.inertia_B(), c,
                          scene.omega().cwiseProduct(Vector3d::Ones() + sign * nudge * signs));
      };
      error += 2 * (unit_roundoff / nudge) * compare(scene, perturbed(1), perturbed(-1));
    }
    return error + measure_inertia(scene, [&](double sign) {
             return DampedFree(nudge_moments(scene, sign), c, to_principal(scene, scene.omega()));
           });
  }

 private:
  /// The change of the motion when the times change by a part of themselves, in units of this part.
  double measure_span(const Scene& scene, const Facts& facts) const {
    const double slowed = std::max(motion().slowed_time(facts.after), -motion().slowed_time(-facts.before));
    const double grown = std::abs(motion().damping()) * facts.span();
    return scene.omega().norm() * slowed * (1 + grown) + grown;
  }
};

}  // namespace

constinit const ClosedFormRecord damped_free_form{
    .name = "damped_free",
    .type = "DampedFree",
    .doc = "damping proportional to the angular momentum, -c I omega: the free motion in slowed time",
    .source = "a change of time in Euler's equations",
    .set_up_seconds = 2e-6,
    .sample_seconds = 3.5e-8,
    .refuse = refuse_damped,
    .make = [](const Scene& scene, const Facts&) -> std::unique_ptr<const ClosedForm> {
      const double rate = find_proportional_damping(scene)->rate;
      return std::make_unique<DampedForm>(damped_free_form,
                                          DampedFree(scene.inertia_B(), rate, scene.omega(), scene.attitude()));
    },
    .explain = [](const Scene& scene, const Facts&) {
      char text[160];
      std::snprintf(text, sizeof text,
                    "The damping is -c I omega with c = %.3g /s. The motion is the free one in slowed time, s = (1 - "
                    "exp(-c t)) / c.",
                    find_proportional_damping(scene)->rate);
      return std::string(text);
    },
    .count_error_set_ups = [](const Scene& scene, const Facts&) {
      return (find_proportional_damping(scene)->rounded ? 2 : 0) + (inertia_is_rounded(scene) ? 2 : 0);
    },
    .is_near = [](const Scene& scene, const Facts&) { return only_damps(scene); }};

}  // namespace polhode::form
