#include "polhode/exact/pendulum.hpp"

#include "polhode/math/detail/functions.hpp"
#include "solve/form/forms.hpp"
#include "solve/form/input_error.hpp"
#include "solve/form/parts.hpp"

// The plane pendulum.
namespace polhode::form {
namespace {

Pendulum make_pendulum(const Scene& scene) {
  const torques::Gravity& gravity = *find_only_gravity(scene);
  return {scene.inertia_B(), gravity.weight(), gravity.arm(), scene.omega(), scene.attitude()};
}

Refusal refuse_pendulum(const Scene& scene, const Facts& facts, Words words) {
  if (facts.is_free()) return refuse(words, "no gravity acts");
  const torques::Gravity* gravity = find_only_gravity(scene);
  if (gravity == nullptr) return refuse(words, "needs gravity as the only torque");
  std::string why_not =
      Pendulum::refuse(scene.inertia_B(), gravity->weight(), gravity->arm(), scene.omega(), scene.attitude());
  if (!why_not.empty()) return {true, std::move(why_not)};
  if (!facts.torques.rotors) return holds();
  if (has_carrier(scene)) return refuse(words, "free rotors reduce the inertia, by a rounded amount");
  const Vector3d axis = make_pendulum(scene).axis();
  Eigen::Index along = 0;   // it is a body axis
  axis.cwiseAbs().maxCoeff(&along);
  if (is_along(facts.rotor_momentum, static_cast<int>(along))) return holds();
  return refuse(words, "the rotors' momentum is not along the axis of rotation");
}

class PendulumForm final : public ClosedFormOf<Pendulum> {
 public:
  using ClosedFormOf::ClosedFormOf;

  double rate(const double* omega) const override {
    return math::hypot(math::hypot(omega[0], omega[1], omega[2]), motion().frequency());
  }
  double swing_frequency() const override { return motion().frequency(); }
  std::optional<Vector3d> swing_axis() const override { return motion().axis(); }

  /// The product of weight and arm is a double-double there.
  double measure_error(const Scene& scene, const Facts& facts) const override {
    return evaluation_error + measure_times(scene, facts) +
           measure_slow_rates(scene, *find_only_gravity(scene), swing_frequency(), motion());
  }
};

}  // namespace

constinit const ClosedFormRecord pendulum_form{
    .name = "pendulum",
    .type = "Pendulum",
    .doc = "the plane pendulum: any body that swings about a horizontal body axis; Jacobi's elliptic functions",
    .source = "Whittaker 1937, Analytical Dynamics, sec. 44",
    .set_up_seconds = 1e-5,
    .sample_seconds = 1e-8,
    .needs_zeros = true,
    .refuse = refuse_pendulum,
    .make = [](const Scene& scene, const Facts&) -> std::unique_ptr<const ClosedForm> {
      return std::make_unique<PendulumForm>(pendulum_form, make_pendulum(scene));
    },
    .explain = [](const Scene&, const Facts&) -> std::string {
      return "Gravity acts alone, and omega is along a horizontal principal axis across the arm: the body is a plane "
             "pendulum. Elliptic functions give each sample.";
    },
    .count_error_set_ups = count_no_set_ups,
    .is_near = [](const Scene& scene, const Facts&) { return find_only_gravity(scene) != nullptr; }};

}  // namespace polhode::form
