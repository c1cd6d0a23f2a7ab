#include <cmath>
#include <numbers>

#include "polhode/exact/gyrostat.hpp"
#include "polhode/math/detail/functions.hpp"
#include "solve/form/forms.hpp"
#include "solve/form/input_error.hpp"
#include "solve/form/parts.hpp"

// A free body with rotors that spin.
namespace polhode::form {
namespace {

Refusal refuse_gyrostat(const Scene& scene, const Facts& facts, Words words) {
  if (!facts.torques.rotors) return refuse(words, "no rotor turns");
  if (facts.torques.acting == 1) return holds();
  return refuse(words, [&] { return "not free: " + list_torques(scene, facts); });
}

class GyrostatForm final : public ClosedFormOf<Gyrostat> {
 public:
  using ClosedFormOf::ClosedFormOf;

  double rate(const double* omega) const override {
    const double w = math::hypot(omega[0], omega[1], omega[2]);
    return w > 0.0 ? math::hypot(w, compute_nutation_rate(motion().inertia(), motion().momentum())) : 0.0;
  }

  double measure_error(const Scene& scene, const Facts& facts) const override {
    const Vector3d& h = facts.rotor_momentum;
    const auto make = [&](const Vector3d& omega, const Vector3d& momentum) {
      return Gyrostat(scene.inertia_B(), momentum, omega, scene.attitude());
    };
    double error = evaluation_error + measure_times(scene, facts);
    error += measure_rotors(scene, h, motion(), [&](const Vector3d& other) { return make(scene.omega(), other); });
    error += measure_inertia(scene, [&](double sign) {
      return Gyrostat(nudge_moments(scene, sign), to_principal(scene, h), to_principal(scene, scene.omega()),
                      scene.attitude());
    });
    return error + measure_inputs(scene, h, make) + measure_energy(scene, facts);
  }

 private:
  /// Of all inputs, where the start is next to a steady rotation that appears together with its saddle. There the
  /// closed form is only as good as its inputs (docs/gyrostat.md). Its period is many revolutions long there.
  template <class Make>
  double measure_inputs(const Scene& scene, const Vector3d& h, const Make& make) const {
    constexpr double many = 100.0;
    const double turns = motion().period() * scene.omega().norm() / (2 * std::numbers::pi);
    if (!(turns > many) || std::isinf(turns)) return 0.0;
    const auto perturbed = [&](double sign) {
      const Vector3d up = Vector3d::Ones() + sign * nudge * signs, down = Vector3d::Ones() - sign * nudge * signs;
      return make(scene.omega().cwiseProduct(up), h.cwiseProduct(down));
    };
    return 4 * (unit_roundoff / nudge) * compare(scene, perturbed(1), perturbed(-1));
  }

  /// Of the rates, whose two series cancel next to such a start: the energy of a period shows it.
  double measure_energy(const Scene& scene, const Facts& facts) const {
    constexpr std::size_t count = 129;
    if (motion().energy() == 0.0) return 0.0;
    const double whole = facts.span(), period = motion().period();
    const double span = period > 0.0 && period < whole ? period : whole;
    double t[count], omega[3 * count], largest = 0.0;
    for (std::size_t i = 0; i < count; ++i) t[i] = span * static_cast<double>(i) / (count - 1) - facts.before;
    at(t, count, omega, nullptr);
    for (std::size_t i = 0; i < count; ++i) {
      const Vector3d w{omega[3 * i], omega[3 * i + 1], omega[3 * i + 2]};
      const double energy = 0.5 * w.dot(scene.inertia_B().matrix() * w);
      largest = std::max(largest, std::abs(energy / motion().energy() - 1.0));
    }
    return 4 * std::max(0.0, largest - 16 * epsilon);
  }
};

}  // namespace

constinit const ClosedFormRecord gyrostat_form{
    .name = "gyrostat",
    .type = "Gyrostat",
    .doc = "a free body with rotors: one theta series for every regime",
    .source = "Zhukovsky 1885; Volterra 1899, Acta Math. 22; Wittenburg 1977",
    .set_up_seconds = 2e-5,
    .sample_seconds = 1.2e-8,
    .slow_set_up = true,
    .refuse = refuse_gyrostat,
    .make = [](const Scene& scene, const Facts& facts) -> std::unique_ptr<const ClosedForm> {
      return std::make_unique<GyrostatForm>(
          gyrostat_form, Gyrostat(scene.inertia_B(), facts.rotor_momentum, scene.omega(), scene.attitude()));
    },
    .explain = [](const Scene&, const Facts&) -> std::string {
      return "No torque acts, and the rotors' momentum is constant in the body: a free gyrostat. One theta series gives "
             "each sample directly, without steps.";
    },
    .count_error_set_ups = [](const Scene& scene, const Facts& facts) {
      return (inertia_is_rounded(scene) ? 2 : 0) + count_lost_components(scene, facts.rotor_momentum);
    }};

}  // namespace polhode::form
