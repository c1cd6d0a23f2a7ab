#include "polhode/orbit/orbit.hpp"

#include <doctest/doctest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "polhode/core/error.hpp"
#include "polhode/torque/magnetic_field.hpp"
#include "polhode/torque/orbit_gradient.hpp"
#include "polhode/torque/plates.hpp"

// An orbit as torques and formulas see it: its series against its closed form.
TEST_SUITE("orbit") {
  using namespace polhode;
  using formula::Ephemeris;

  std::vector<Orbit> list_orbits() {
    std::vector<Orbit> orbits;
    for (const double e : {0.0, 0.1, 0.97, 1.0, 1.0 + 1e-12, 4.2}) {
      OrbitElements elements{.mu = 3.0, .periapsis_distance = 2.0, .e = e, .inclination = 0.9, .node = 0.3,
                             .periapsis = 0.8, .anomaly = -0.7};
      orbits.push_back(Orbit::from_elements(elements));
      if (e >= 1.0) continue;
      elements.j2 = 0.05, elements.radius = 1.5;
      orbits.push_back(Orbit::from_elements(elements));
    }
    return orbits;
  }

  TEST_CASE("the series of an orbit sums to its closed form") {
    constexpr int order = 24;
    for (const Orbit& orbit : list_orbits()) {
      const Ephemeris seen = orbit.ephemeris();
      std::vector<double> rows(Ephemeris::size * (order + 1));
      const double t = 1.3, unit = 0.125;
      seen.path()->expand(math::DD(t), unit, order, rows.data());
      for (const double h : {0.0, 0.1, -0.15}) {
        const auto expected = seen.at(t + h);
        for (std::size_t i = 0; i < Ephemeris::size; ++i) {
          double sum = 0.0;
          for (std::size_t n = order + 1; n-- > 0;) sum = sum * (h / unit) + rows[Ephemeris::size * n + i];
          CHECK(sum == doctest::Approx(expected[i]).epsilon(1e-13));
        }
      }
    }
  }

  TEST_CASE("equal orbits are one ephemeris of a graph") {
    const Orbit a = Orbit::from_state(1.0, {1, 0, 0}, {0, 1, 0}), same = Orbit::from_state(1.0, {1, 0, 0}, {0, 1, 0});
    const Orbit other = Orbit::from_state(1.0, {1, 0, 0}, {0, 1, 1e-15});
    CHECK(a == same);
    CHECK_FALSE(a == other);
    CHECK(a == *Orbit::from_ephemeris(a.ephemeris("main")));
    formula::Graph graph;
    CHECK(graph.ephemeris(a.ephemeris(), 0) == graph.ephemeris(same.ephemeris("main"), 0));
    CHECK_FALSE(graph.ephemeris(a.ephemeris(), 0) == graph.ephemeris(other.ephemeris(), 0));
    CHECK(graph.ephemerides().size() == 2);
  }

  TEST_CASE("torques on an orbit in C++") {
    const Orbit orbit = list_orbits()[1];
    const OrbitState now = orbit.at(0.7);
    Matrix3d inertia = Vector3d(1, 2, 2.5).asDiagonal();
    const double omega[3] = {}, attitude[4] = {0, 0, 0, 1};
    Vector3d tau = Vector3d::Zero();
    torques::OrbitGradient(orbit.ephemeris()).add({0.7, omega, attitude, inertia}, tau.data());
    const Vector3d expected = 9.0 / std::pow(now.r.norm(), 5) * now.r.cross(inertia * now.r);
    CHECK((tau - expected).norm() <= 1e-14 * expected.norm());

    const MagneticField field = MagneticField::dipole(orbit.ephemeris(), 2.0, 0.3, 0.1);
    tau.setZero();
    torques::make_dipole({1, 2, 3}, field).add({0.7, omega, attitude, inertia}, tau.data());
    const Vector3d turned = Vector3d(1, 2, 3).cross(field.at(0.7, now.r));
    CHECK((tau - turned).norm() <= 1e-14 * turned.norm());

    tau.setZero();
    torques::make_solar_pressure({{2.0, {0, 0, 3}, {1, 0, 0}}}, {0, 0, 5}, 0.5).add({0.7, omega, attitude, inertia},
                                                                                    tau.data());
    CHECK((tau - Vector3d(0, 1, 0)).norm() <= 1e-15);
    tau.setZero();
    torques::make_drag({{2.0, now.v, {1, 0, 0}}}, orbit.ephemeris(), 2.2, {0.1, now.r.norm(), 1.0})
        .add({0.7, omega, attitude, inertia}, tau.data());
    const Vector3d dragged = -0.22 * now.v.norm() * Vector3d(1, 0, 0).cross(now.v);
    CHECK((tau - dragged).norm() <= 1e-14 * dragged.norm());

    const auto pushed = torques::Formula::from([&](const auto& in) { return formula::see(orbit.ephemeris(), in.t).v; });
    tau.setZero();
    pushed.add({0.7, omega, attitude, inertia}, tau.data());
    CHECK((tau - now.v).norm() <= 1e-15 * now.v.norm());
  }

  TEST_CASE("what torques cannot take is refused") {
    const Orbit table = Orbit::table({0.0, 1.0}, {{1, 0, 0}, {0, 1, 0}}, {{0, 1, 0}, {-1, 0, 0}});
    CHECK_THROWS_AS(table.ephemeris(), InvalidInput);
    formula::Graph graph;
    const formula::Expr t(graph, graph.time());
    CHECK_THROWS_AS(formula::see(list_orbits()[0].ephemeris(), t + 1.0), InvalidInput);
    for (int i = 0; i < formula::Graph::most_ephemerides; ++i)
      graph.ephemeris(Orbit::from_state(1.0 + i, {1, 0, 0}, {0, 1, 0}).ephemeris(), 0);
    CHECK_THROWS_AS(graph.ephemeris(Orbit::from_state(0.5, {1, 0, 0}, {0, 1, 0}).ephemeris(), 0), InvalidInput);
  }
}
