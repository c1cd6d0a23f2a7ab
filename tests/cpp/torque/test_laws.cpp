// The law of each torque of the list, as a formula, against its function.

#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <vector>

#include "polhode/formula/recognise.hpp"
#include "polhode/formula/trace.hpp"
#include "polhode/torque/torques.hpp"

namespace polhode {
namespace {

Matrix3d make_inertia() {
  Matrix3d I;
  I << 1.2, 0.2, -0.1, 0.2, 2.0, 0.3, -0.1, 0.3, 1.7;
  return I;
}

std::vector<AnyTorque> list_torques() {
  Matrix3d C;
  C << 0.3, 0.1, 0.0, -0.2, 0.4, 0.05, 0.0, 0.1, 0.2;
  const torques::Formula spin = torques::Formula::from(
      [](const auto& in) { return cross(in.omega, in.template p<3>("h")) * tanh(in.attitude.w()); },
      {{"h", {0.1, 0.7, -0.3}}});
  return {torques::Constant({0.1, -0.2, 0.3}, torques::Constant::Frame::body),
          torques::Constant({0.1, -0.2, 0.3}, torques::Constant::Frame::space),
          torques::Gravity(2.0, {0.3, 0.2, 0.5}),
          torques::GravityGradient(0.7, 0.4),
          torques::Damping(C),
          torques::AngularDamping(0.3),
          spin,
          torques::During(torques::Damping(C), {{-1e9, 1e9}})};
}

}  // namespace

TEST_CASE("the law of each torque is its function") {
  const Matrix3d I = make_inertia();
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (const AnyTorque& torque : list_torques()) {
    CAPTURE(torque_name(torque));
    const formula::Program law = make_bound_law(torque, I);
    REQUIRE(law.outputs.size() == 3);
    formula::Evaluator evaluate(law);
    const std::vector<double> parameters = formula::list_values(law.parameters);
    for (int round = 0; round < 20; ++round) {
      double y[7], size = 0.0, tau[3] = {0.0, 0.0, 0.0}, value[3];
      for (double& number : y) number = normal(random);
      for (int i = 3; i < 7; ++i) size += y[i] * y[i];
      for (int i = 3; i < 7; ++i) y[i] /= std::sqrt(size);
      const double t = normal(random);
      std::visit([&](const auto& any) { any.add(TorqueInput{t, y, y + 3, I}, tau); }, torque);
      evaluate(t, y, parameters.data(), value);
      for (int i = 0; i < 3; ++i) CHECK(std::abs(value[i] - tau[i]) < 4e-15);
    }
  }
  const auto rate = [](double, const double*, const double*, double*, void*) {};
  CHECK_THROWS(make_law(torques::Custom(rate, nullptr, {}), I));
}

static_assert(torques::HasKernel<torques::Gravity> && torques::HasKernel<torques::GravityGradient>);
static_assert(!torques::HasKernel<torques::Custom> && !torques::HasKernel<torques::Formula>);

TEST_CASE("what a torque with kernels says it is, is what its law is") {
  const Matrix3d I = make_inertia();
  int kernels = 0;
  for (const AnyTorque& torque : list_torques()) {
    const std::optional<formula::KnownTorque> known = find_known(torque);
    if (!known) continue;
    CAPTURE(torque_name(torque));
    ++kernels;
    const formula::Recognition found = formula::recognise(make_bound_law(torque, I), I);
    REQUIRE(found.is_whole);
    REQUIRE(found.parts.size() == 1);
    const formula::KnownTorque& part = found.parts[0];
    CHECK(part.kind == known->kind);
    CHECK((part.vector - known->vector).norm() < 1e-15);
    CHECK((part.matrix - known->matrix).norm() < 1e-15);
    CHECK(std::abs(part.rate - known->rate) < 1e-15);
    CHECK(std::abs(part.phase - known->phase) < 1e-15);
  }
  CHECK(kernels == 6);
}

TEST_CASE("an open law with the inertia bound is the law, and its slope by the inertia is its difference") {
  const Matrix3d I = make_inertia();
  Matrix3d dI;
  dI << 0.3, 0.1, 0.0, 0.1, -0.2, 0.05, 0.0, 0.05, 0.4;
  const double w[3] = {0.4, -0.7, 0.2}, q[4] = {0.1, -0.7, 0.5, 0.5}, t = 0.6;
  for (const AnyTorque& torque : list_torques()) {
    CAPTURE(torque_name(torque));
    const double y[7] = {w[0], w[1], w[2], q[0], q[1], q[2], q[3]};
    const formula::Program open = make_open_law(torque, I), slope = make_inertia_slope(torque, I, dI);
    double value[3], rate[3], up[3] = {}, down[3] = {};
    const std::vector<double> parameters = formula::list_values(open.parameters);
    formula::Evaluator evaluate(open), differentiate(slope);
    evaluate(t, y, parameters.data(), value), differentiate(t, y, nullptr, rate);
    const double h = 0x1p-10;
    const Matrix3d above = I + h * dI, below = I - h * dI;
    std::visit([&](const auto& any) {
      any.add(TorqueInput{t, w, q, above}, up), any.add(TorqueInput{t, w, q, below}, down);
    }, torque);
    for (int i = 0; i < 3; ++i) {
      CHECK(std::abs(value[i] - 0.5 * (up[i] + down[i])) < 1e-14);
      CHECK(std::abs(rate[i] - (up[i] - down[i]) / (2 * h)) < 1e-12);
    }
  }
}

}  // namespace polhode
