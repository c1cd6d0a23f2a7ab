#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "polhode/exact/free_motion.hpp"
#include "polhode/solve/closed_form.hpp"
#include "polhode/solve/facts.hpp"

using namespace polhode;

namespace {

constexpr double turn = 2 * std::numbers::pi;

SceneParts block(const Vector3d& omega, std::vector<AnyTorque> torques = {}) {
  return {.inertia_B = InertiaTensor::from_moments({0.20, 0.40, 0.52}),
          .omega = omega,
          .torques = std::move(torques),
          .times = {0.0, 10.0}};
}

}  // namespace

TEST_CASE("facts: span, what is wanted, turns") {
  SceneParts parts = block({0, 3, 4});
  parts.times = {7.0, -3.0, 2.0};
  parts.t0 = 1.0;
  const Facts facts = compute_facts(Scene(parts));
  CHECK(facts.before == 4.0);
  CHECK(facts.after == 6.0);
  CHECK(facts.span() == 10.0);
  CHECK(!facts.only_at_end);
  CHECK(facts.turns == doctest::Approx(50 / turn));
  CHECK(facts.is_free());
  parts.times = {5.0, 5.0};
  CHECK(compute_facts(Scene(parts)).only_at_end);
}

TEST_CASE("facts: gaps of the moments are relative and sorted") {
  for (const double s : {1e-12, 1.0, 1e12}) {
    SceneParts parts = block({1, 2, 3});
    parts.inertia_B = InertiaTensor::from_moments({0.52 * s, 0.20 * s, 0.40 * s});
    const Facts facts = compute_facts(Scene(parts));
    CHECK(facts.gap_low == doctest::Approx(0.20 / 0.52));
    CHECK(facts.gap_high == doctest::Approx(0.12 / 0.52));
    CHECK(facts.symmetry == Symmetry::triaxial);
  }
}

TEST_CASE("facts: the angle to the nearest principal axis") {
  CHECK(compute_off_axis_angle(Scene(block({0, -5, 0}))) == 0.0);
  CHECK(compute_off_axis_angle(Scene(block({0, 0, 0}))) == 0.0);
  CHECK(compute_off_axis_angle(Scene(block({0.1, 0, -1}))) == doctest::Approx(std::atan(0.1)));
  CHECK(compute_off_axis_angle(Scene(block({1, 1, 1}))) == doctest::Approx(std::acos(1 / std::sqrt(3.0))));
}

TEST_CASE("facts: distance of the separatrix is k'^2 of the free motion") {
  // Against k^2 = (I2 - I1)(2 T I3 - L^2) / ((I3 - I2)(L^2 - 2 T I1)), or its mirror image, written out.
  for (const Vector3d& w : {Vector3d{1, 2, 3}, Vector3d{3, 2, 1}, Vector3d{0.5, -5, 0.01}, Vector3d{0.01, 5, 0.5}}) {
    const double I1 = 0.20, I2 = 0.40, I3 = 0.52;
    const double L2 = std::pow(I1 * w[0], 2) + std::pow(I2 * w[1], 2) + std::pow(I3 * w[2], 2);
    const double T2 = I1 * w[0] * w[0] + I2 * w[1] * w[1] + I3 * w[2] * w[2];
    const double k2 = L2 > T2 * I2 ? (I2 - I1) * (T2 * I3 - L2) / ((I3 - I2) * (L2 - T2 * I1))
                                   : (I3 - I2) * (L2 - T2 * I1) / ((I2 - I1) * (T2 * I3 - L2));
    for (const double s : {1e-9, 1.0, 1e9}) {
      CHECK(compute_separatrix_distance(Scene(block(s * w))) == doctest::Approx(1 - k2).epsilon(1e-12));
    }
  }
  CHECK(compute_separatrix_distance(Scene(block({0, 5, 0}))) == 0.0);
  CHECK(compute_separatrix_distance(Scene(block({0, 0, 5}))) == doctest::Approx(1.0));
  CHECK(compute_separatrix_distance(Scene(block({1e-4, 5, 1e-4}))) < 1e-8);
  SceneParts symmetric = block({1, 2, 3});
  symmetric.inertia_B = InertiaTensor::from_moments({1, 1, 2});
  CHECK(compute_separatrix_distance(Scene(symmetric)) == 1.0);
}

TEST_CASE("facts: the fastest decay is an eigenvalue of I^-1 C") {
  CHECK(compute_facts(Scene(block({1, 2, 3}))).decay == 0.0);
  const Matrix3d diagonal = Vector3d{0.2, 4.0, 0.52}.asDiagonal();
  const Facts facts = compute_facts(Scene(block({1, 2, 3}, {torques::Damping(diagonal)})));
  CHECK(facts.decay == doctest::Approx(10.0));
  CHECK(facts.stiffness == doctest::Approx(100.0));
  CHECK(!facts.may_spin_up);
  // The scene S7b: C = 0.01 E + 1e5 n n^T, largest eigenvalue of I^-1 C as its page states it.
  SceneParts parts = block({1, 2, 3});
  parts.inertia_B = InertiaTensor::from_moments({1, 2, 2.5});
  const Vector3d n{1.0 / 3, 2.0 / 3, 2.0 / 3};
  parts.torques = {torques::Damping(0.01 * Matrix3d::Identity() + 1e5 * n * n.transpose())};
  CHECK(compute_facts(Scene(parts)).decay == doctest::Approx(5.1111e4).epsilon(1e-5));
  parts.torques = {torques::Damping(-diagonal)};
  CHECK(compute_facts(Scene(parts)).decay == 0.0);   // it drives, it does not damp
}

TEST_CASE("facts: a thruster may spin a body up, gravity and damping do not") {
  const torques::Constant thruster({0.01, -0.02, 0.03});
  const Facts up = compute_facts(Scene(block({0.1, 0.2, 0.3}, {thruster})));
  CHECK(up.may_spin_up);
  CHECK(up.turns > (std::sqrt(0.14) * 10) / turn);
  // Turns of the scene S9 carried on, integrated by SciPy's DOP853 at 1e-10.
  for (const auto& [span, truth] : {std::pair{10.0, 0.938487}, {100.0, 49.3240}, {1000.0, 4621.87}}) {
    SceneParts parts = block({0.1, 0.2, 0.3}, {thruster});
    parts.times = {span};
    CHECK(compute_facts(Scene(parts)).turns == doctest::Approx(truth).epsilon(0.1));
  }
  const Facts heavy = compute_facts(Scene(block({0, 0, 0}, {torques::Gravity(2, {0, 0, 1})})));
  CHECK(!heavy.may_spin_up);
  CHECK(heavy.turns == doctest::Approx(std::sqrt(2 / 0.20) * 10 / turn));
  CHECK(heavy.torques.keeps_energy);
  CHECK(heavy.torques.keeps_vertical);
  CHECK(heavy.torques.uses_attitude);
}

TEST_CASE("facts: torques that vanish are not there") {
  const Scene scene(
      block({1, 2, 3}, {torques::Gravity(0, {1, 2, 3}), torques::GravityGradient(0), torques::Constant({0, 0, 0})}));
  CHECK(find_acting_torques(scene).acting == 0);
  CHECK(!find_acting_torques(scene).uses_attitude);
  CHECK(scene.torque_sum().acting == 0);
  SceneParts sphere = block({1, 2, 3}, {torques::GravityGradient(0.1)});
  CHECK(find_acting_torques(Scene(sphere)).acting == 1);
  sphere.inertia_B = InertiaTensor::from_moments({2, 2, 2});
  CHECK(find_acting_torques(Scene(sphere)).acting == 0);
}

TEST_CASE("every free model names itself, and only where it holds") {
  const auto model = [](const Vector3d& moments, const Vector3d& omega) {
    SceneParts parts{.inertia_B = InertiaTensor::from_moments(moments), .omega = omega, .times = {1.0}};
    const Scene scene(parts);
    const Facts facts = compute_facts(scene);
    const std::string name(find_closed_form(scene, facts)->name());
    for (const ClosedFormRecord* one : closed_forms()) {
      if (one->name == name) CHECK(!one->refuse(scene, facts, Words::yes));
    }
    return name;
  };
  CHECK(model({1, 2, 2.5}, {0, 0, 0}) == "rest");
  CHECK(model({2, 2, 2}, {1, 2, 3}) == "spherical");
  CHECK(model({1, 2, 2.5}, {0, 1, 0}) == "steady");
  CHECK(model({1, 1, 0.5}, {1, 2, 3}) == "symmetric");
  CHECK(model({3, 4, 6}, {2, 1, 1}) == "separatrix");
  CHECK(model({1, 2, 2.5}, {1, 2, 3}) == "triaxial");
}
