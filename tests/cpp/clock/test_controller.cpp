#include <doctest/doctest.h>

#include <cmath>

#include "polhode/clock/controller.hpp"
#include "polhode/solve/solve.hpp"

using namespace polhode;

namespace {

ControllerParts make_parts() {
  ControllerParts parts;
  parts.period = 0.1;
  parts.law.initial = {0.0, 0.0, 0.0};
  parts.law.parameters = {{"kd", {3.0}}, {"kp", {2.0}}};
  return parts;
}

Controller make_traced() {
  return Controller::from(
      [](const auto& in) {
        using T = std::decay_t<decltype(in.t)>;
        const auto tau = in.attitude.xyz() * (-in.p("kp") * in.attitude[3]) - in.omega * in.p("kd");
        return Controller::Result<T>{{tau[0], tau[1], tau[2]}, {}};
      },
      make_parts());
}

Controller make_text() {
  ControllerParts parts = make_parts();
  parts.law.command = "-kp * attitude.xyz * attitude.w - kd * omega";
  return Controller(parts);
}

Scene make_scene(std::vector<Controller> controllers, std::vector<double> times = {0.0, 0.5, 1.0}) {
  SceneParts parts{.inertia_B = InertiaTensor::from_moments({1.0, 2.0, 2.5}), .omega = {0.2, -0.3, 0.1}};
  parts.attitude = normalized(Quat{0.5, -0.3, 0.2, 0.7});
  parts.times = std::move(times), parts.controllers = std::move(controllers);
  return Scene(std::move(parts));
}

}  // namespace

TEST_CASE("a controller from a callable, from a text and from a function moves a body alike") {
  ControllerParts called = make_parts();
  called.function = [](double, const double* in, double* out) {
    for (int i = 0; i < 3; ++i) out[i] = -2.0 * in[3 + i] * in[6] - 3.0 * in[i];
  };
  const Motion traced = solve(make_scene({make_traced()}), {.accuracy = 1e-10});
  const Motion text = solve(make_scene({make_text()}), {.accuracy = 1e-10});
  const Motion function = solve(make_scene({Controller(called)}), {.accuracy = 1e-10});
  CHECK(traced.error_kind == "bounded");
  CHECK(function.error_kind == "estimated");
  for (std::size_t i = 0; i < traced.omega.size(); ++i) {
    CHECK(std::abs(traced.omega[i] - text.omega[i]) < 1e-15);
    CHECK(std::abs(traced.omega[i] - function.omega[i]) < 1e-13);
  }
  CHECK(traced.ticks[0].t.size() == 10);
}

TEST_CASE("a run goes on with its series where a tick changes nothing") {
  ControllerParts parts = make_parts();
  parts.law.parameters.clear();
  parts.law.command = "0 * omega";
  parts.period = 1e-3;
  const Motion coast = solve(make_scene({Controller(parts)}), {.accuracy = 1e-10});
  SceneParts bare = make_scene({}).parts();
  const Motion free = solve(Scene(std::move(bare)), {.accuracy = 1e-10});
  CHECK(coast.ticks[0].t.size() == 1000);
  CHECK(coast.stats.steps < 100);
  for (std::size_t i = 0; i < free.omega.size(); ++i) CHECK(std::abs(coast.omega[i] - free.omega[i]) < 1e-12);
}

TEST_CASE("tick times are one product and one sum") {
  ControllerParts parts = make_parts();
  parts.start = 0.3, parts.law.command = "-omega";
  const Controller controller(parts);
  CHECK(controller.tick(7) == 0.3 + 7.0 * 0.1);
}

TEST_CASE("a controller refuses numbers out of range") {
  const auto refuses = [](auto&& change, const char* words) {
    ControllerParts parts = make_parts();
    parts.law.command = "-omega";
    change(parts);
    CHECK_THROWS_WITH_AS(Controller{parts}, doctest::Contains(words), InvalidInput);
  };
  refuses([](ControllerParts& p) { p.period = 0.0; }, "Controller.period");
  refuses([](ControllerParts& p) { p.delay = -1.0; }, "Controller.delay");
  refuses([](ControllerParts& p) { p.width = 0.2; }, "Controller.width");
  refuses([](ControllerParts& p) { p.output = Output::dipole; }, "Controller.field");
  refuses([](ControllerParts& p) { p.law.initial = {0.0}; }, "Controller.initial");
  refuses([](ControllerParts& p) { p.law.command = "-speed"; }, "Controller.command");
}
