#include "polhode/exact/heavy_top.hpp"

#include <algorithm>
#include <cmath>

#include "polhode/math/detail/functions.hpp"
#include "solve/form/forms.hpp"
#include "solve/form/input_error.hpp"
#include "solve/form/parts.hpp"

// Lagrange's top, without and with a rotor on its axis.
namespace polhode::form {
namespace {

/// What both tops require.
Refusal refuse_symmetric_top(const Scene& scene, const Facts& facts, Words words) {
  const torques::Gravity* gravity = find_only_gravity(scene);
  if (gravity == nullptr) return refuse(words, "needs gravity as the only torque");
  if (find_top_axis(scene, gravity->arm())) return holds();
  const double gap = std::min(facts.gap_low, facts.gap_high);
  if (gap > symmetry_gap)
    return refuse(words, [&] { return "the closest two moments differ by " + to_percent(gap); });
  return refuse(words, "the centre of mass is off the axis whose other two moments are equal bit for bit");
}

Refusal refuse_top(const Scene& scene, const Facts& facts, Words words) {
  if (facts.is_free()) return refuse(words, "no gravity acts");
  return facts.torques.rotors ? refuse(words, "rotors turn with the body") : refuse_symmetric_top(scene, facts, words);
}

Refusal refuse_heavy_gyrostat(const Scene& scene, const Facts& facts, Words words) {
  if (!facts.torques.rotors) return refuse(words, "no rotor turns");
  if (facts.torques.acting == 1) return refuse(words, "no gravity acts");
  if (Refusal why_not = refuse_symmetric_top(scene, facts, words)) return why_not;
  const int axis = *find_top_axis(scene, find_only_gravity(scene)->arm());
  if (is_along(facts.rotor_momentum, axis)) return holds();
  return refuse(words, "the rotors' momentum is not along the axis of symmetry");
}

class TopForm final : public ClosedFormOf<HeavyTop> {
 public:
  TopForm(const torques::Gravity& gravity, int axis, double weight_arm, HeavyTop motion)
      : ClosedFormOf(motion.rotor() == 0.0 ? heavy_top_form : heavy_gyrostat_form, std::move(motion)),
        gravity_(gravity), axis_(axis), weight_arm_(weight_arm) {}

  double rate(const double* omega) const override {
    const Vector3d& moments = motion().inertia().moments();
    return math::hypot(math::hypot(omega[0], omega[1], omega[2]),
                       std::sqrt(std::abs(motion().weight_arm()) / moments[2]), motion().rotor() / moments[0]);
  }

  double swing_frequency() const override {   // the middle moment is of the equal pair
    return std::sqrt(std::abs(motion().weight_arm()) / motion().inertia().moments()[1]);
  }

  double measure_error(const Scene& scene, const Facts& facts) const override {
    const Vector3d& h = facts.rotor_momentum;
    const auto make = [&](const InertiaTensor& inertia, double weight_arm, double rotor) {
      return HeavyTop(inertia, weight_arm, scene.omega(), scene.attitude(), rotor);
    };
    double error = evaluation_error + measure_times(scene, facts);
    error += measure_slow_rates(scene, gravity_, swing_frequency(), motion());
    if (weight_is_rounded(gravity_, axis_)) {
      error += 4 * (unit_roundoff / nudge) *
               compare(scene, motion(), make(scene.inertia_B(), weight_arm_ * (1 + nudge), h[axis_]));
    }
    if (facts.torques.rotors) {
      error += measure_rotors(scene, h, motion(), [&](const Vector3d& other) {
        return make(scene.inertia_B(), weight_arm_, other[axis_]);
      });
    }
    error += measure_inertia(scene, [&](double sign) {   // two moments stay equal
      const double largest = scene.given_inertia_B().moments()[2];
      Vector3d I = scene.inertia_B().matrix().diagonal() + sign * nudge * largest * Vector3d::Ones();
      I[axis_] -= 2 * sign * nudge * largest;
      return make(InertiaTensor::from_moments(I, false), weight_arm_, h[axis_]);
    });
    return error + measure_rotor_rates(scene, h[axis_]);
  }

  static bool weight_is_rounded(const torques::Gravity& gravity, int axis) {
    return std::fma(gravity.weight(), gravity.arm()[axis], -(gravity.weight() * gravity.arm()[axis])) != 0.0;
  }

 private:
  /// Of the rates across the axis of a top with a rotor: they come from a plain top that rotates faster by h / C, and
  /// have its rounding. Measured: 0.06 units of the faster rate.
  double measure_rotor_rates(const Scene& scene, double h) const {
    if (h == 0.0) return 0.0;
    const double added = std::abs(h) / scene.inertia_B().matrix()(axis_, axis_);
    const double largest = find_largest_rate(scene, motion());
    return largest > 0.0 ? epsilon * added / largest : 0.0;
  }

  torques::Gravity gravity_;
  int axis_;             // of symmetry
  double weight_arm_;
};

std::unique_ptr<const ClosedForm> make_top(const Scene& scene, const Facts& facts) {
  const torques::Gravity& gravity = *find_only_gravity(scene);
  const int axis = *find_top_axis(scene, gravity.arm());
  const double weight_arm = gravity.weight() * gravity.arm()[axis];
  const double rotor = facts.torques.rotors ? facts.rotor_momentum[axis] : 0.0;
  return std::make_unique<TopForm>(
      gravity, axis, weight_arm, HeavyTop(scene.inertia_B(), weight_arm, scene.omega(), scene.attitude(), rotor));
}

int count_top_set_ups(const Scene& scene, const Facts& facts) {
  const torques::Gravity& gravity = *find_only_gravity(scene);
  return (TopForm::weight_is_rounded(gravity, *find_top_axis(scene, gravity.arm())) ? 1 : 0) +
         (inertia_is_rounded(scene) ? 2 : 0) +
         (facts.torques.rotors ? count_lost_components(scene, facts.rotor_momentum) : 0);
}

}  // namespace

constinit const ClosedFormRecord heavy_top_form{
    .name = "heavy_top",
    .type = "HeavyTop",
    .doc = "Lagrange's top: a symmetric body on a pivot on its axis under gravity; theta functions",
    .source = "Klein & Sommerfeld 1897-1910",
    .set_up_seconds = 3.6e-6,
    .sample_seconds = 9e-9,
    .refuse = refuse_top,
    .make = make_top,
    .explain = [](const Scene&, const Facts&) -> std::string {
      return "A symmetric body on a pivot on its axis, with gravity alone, is Lagrange's top. It has a closed form.";
    },
    .count_error_set_ups = count_top_set_ups,
    .is_near = [](const Scene& scene, const Facts& facts) { return !only_damps(scene) && !facts.torques.rotors; }};

constinit const ClosedFormRecord heavy_gyrostat_form{
    .name = "heavy_gyrostat",
    .type = "HeavyTop",
    .doc = "Lagrange's top with a rotor on its axis, as a toy gyroscope: the top in turning axes",
    .source = "Klein & Sommerfeld 1897-1910; Wittenburg 1977",
    .set_up_seconds = 3.6e-6,
    .sample_seconds = 3.5e-8,
    .refuse = refuse_heavy_gyrostat,
    .make = make_top,
    .explain = [](const Scene&, const Facts&) -> std::string {
      return "A symmetric body on a pivot on its axis, with gravity and a rotor on the same axis: Lagrange's top with "
             "omega3 + h / J3, turned back about the axis by h t / J3.";
    },
    .count_error_set_ups = count_top_set_ups,
    .is_near = [](const Scene& scene, const Facts& facts) { return !only_damps(scene) && facts.torques.rotors; }};

}  // namespace polhode::form
