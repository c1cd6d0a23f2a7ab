#include "polhode/derivative/sensitivity.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "polhode/core/error.hpp"
#include "polhode/reference/reference.hpp"

using namespace polhode;

namespace {

/// The numbers of a scene with every torque, a window and two rotors.
struct DrivenNumbers {
  Vector3d moments{1.5, 2.0, 2.5}, omega{0.3, -0.7, 0.5}, arm{0.1, 0.3, -0.2}, thrust{0.2, -0.1, 0.3};
  double weight = 0.8, mean_motion = 0.2, phase = 0.3, rate = 0.04, damping = 0.03, begin = 0.5, end = 1.5;
  double momentum = 0.4, speed = 6.0;

  Scene make() const {
    Matrix3d C = Matrix3d::Zero();
    C(0, 1) = damping, C(2, 2) = 0.02;
    SceneParts parts{InertiaTensor::from_moments(moments)};
    parts.omega = omega;
    parts.attitude = normalized({0.1, 0.7, -0.1, 0.7});
    parts.torques = {torques::Gravity(weight, arm), torques::GravityGradient(mean_motion, phase),
                     torques::AngularDamping(rate), torques::Damping(C),
                     torques::During(torques::Constant(thrust, torques::Constant::Frame::space), {{begin, end}})};
    RotorParts held, windowed;
    held.axis = {0, 0.6, 0.8}, held.momentum = momentum;
    windowed.axis = {1, 0, 0}, windowed.inertia = 0.05, windowed.speed = speed, windowed.windows = {{-1.0, 1.2}};
    parts.rotors = {Rotor(held), Rotor(windowed)};
    parts.times = {-1.0, 1.0, 3.0};
    return Scene(parts);
  }
};

}  // namespace

TEST_CASE("columns of a driven body are differences of the reference") {
  const auto of_vector = [](Vector3d DrivenNumbers::*v, int c) {
    return [v, c](DrivenNumbers& numbers, double d) { (numbers.*v)[c] += d; };
  };
  const auto of_real = [](double DrivenNumbers::*x) {
    return [x](DrivenNumbers& numbers, double d) { numbers.*x += d; };
  };
  std::vector<std::function<void(DrivenNumbers&, double)>> changes;
  for (Vector3d DrivenNumbers::*v : {&DrivenNumbers::omega, &DrivenNumbers::moments, &DrivenNumbers::arm,
                                     &DrivenNumbers::thrust}) {
    for (int c = 0; c < 3; ++c) changes.push_back(of_vector(v, c));
  }
  for (double DrivenNumbers::*x : {&DrivenNumbers::weight, &DrivenNumbers::mean_motion, &DrivenNumbers::phase,
                                   &DrivenNumbers::rate, &DrivenNumbers::momentum, &DrivenNumbers::speed,
                                   &DrivenNumbers::begin, &DrivenNumbers::end}) {
    changes.push_back(of_real(x));
  }
  const MotionSensitivity found = compute_sensitivity(
      DrivenNumbers().make(),
      {"omega", "inertia", "gravity.arm", "constant.torque", "gravity.weight", "torques.1.mean_motion",
       "gravity_gradient.phase", "angular_damping.rate", "rotors.0.momentum", "rotors.1.speed", "torques.4.windows"},
      {.accuracy = 1e-11});
  const std::size_t columns = changes.size();
  REQUIRE(found.columns.size() == columns);
  for (std::size_t c = 0; c < columns; ++c) {
    const std::string name = found.columns[c];
    CAPTURE(name);
    constexpr double d = 1e-5;
    DrivenNumbers plus, minus;
    changes[c](plus, d), changes[c](minus, -d);
    const Reference a = compute_reference(plus.make()), b = compute_reference(minus.make());
    for (std::size_t i = 0; i < 3; ++i) {
      double size = 0.1;
      for (std::size_t k = 0; k < 3; ++k)
        size = std::max(size, std::abs(found.d_omega[3 * columns * i + k * columns + c]));
      const double *p = &a.attitude[4 * i], *m = &b.attitude[4 * i];
      const Quat turned = Quat{p[0], p[1], p[2], p[3]} * conjugate(Quat{m[0], m[1], m[2], m[3]});
      const double turn[3] = {turned.x / d, turned.y / d, turned.z / d};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t at = 3 * columns * i + k * columns + c;
        const double rate = (a.omega[3 * i + k] - b.omega[3 * i + k]) / (2 * d);
        CHECK(std::abs(found.d_omega[at] - rate) < 1e-7 * size);
        CHECK(std::abs(found.d_attitude[at] - turn[k]) < 1e-6 * size);
      }
    }
    CHECK(found.error[c] < 1e-10);
  }
}

TEST_CASE("more than eight columns are those of one group") {
  const Scene scene = DrivenNumbers().make();
  const MotionSensitivity many = compute_sensitivity(scene, {"attitude", "omega", "axes", "torques.3.matrix"});
  const MotionSensitivity few = compute_sensitivity(scene, {"axes"});
  REQUIRE(many.columns.size() == 18);
  CHECK(many.columns[13] == "torques.3.matrix_yy");
  for (std::size_t i = 0; i < 9; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      CHECK(many.d_omega[18 * i + 6 + c] == doctest::Approx(few.d_omega[3 * i + c]).epsilon(1e-9));
}

TEST_CASE("one run without a certificate states no error") {
  const Scene scene = DrivenNumbers().make();
  const MotionSensitivity one = compute_sensitivity(scene, {"omega"}, {.accuracy = 1e-10, .certify = false});
  const MotionSensitivity two = compute_sensitivity(scene, {"omega"}, {.accuracy = 1e-10});
  CHECK(one.error.empty());
  CHECK(one.runs == 1);
  CHECK(two.runs >= 2);
  for (std::size_t i = 0; i < two.d_omega.size(); ++i)
    CHECK(one.d_omega[i] == doctest::Approx(two.d_omega[i]).epsilon(1e-9));
}

TEST_CASE("numbers that a scene does not have are refused") {
  const Scene scene = DrivenNumbers().make();
  for (const char* name : {"gravity.length", "torques.9.weight", "torques.x.weight", "rotors.2.momentum",
                           "rotors.0.speed", "constant.frame", "omega_x", ""}) {
    CAPTURE(name);
    CHECK_THROWS_AS(compute_sensitivity(scene, {name}), InvalidInput);
  }
  CHECK_THROWS_AS(compute_sensitivity(scene, {"omega", "omega"}), InvalidInput);
  CHECK_THROWS_AS(compute_sensitivity(scene, {"omega"}, {.accuracy = 0.0}), InvalidInput);
  CHECK_THROWS_AS(compute_sensitivity(scene, {"omega"}, {.max_steps = 2}), IntegrationFailure);
}
