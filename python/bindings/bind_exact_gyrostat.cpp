#include <pybind11/typing.h>

#include "bind_exact.hpp"
#include "bind_scene.hpp"
#include "convert.hpp"
#include "gil.hpp"
#include "polhode/core/error.hpp"
#include "polhode/exact/gyrostat.hpp"
#include "polhode/scene/scene.hpp"

namespace polhode::python {
namespace {

/// A body with its rotors. The scene knows what each kind means for the inertia and the momentum.
Gyrostat make_with_rotors(const InertiaTensor& inertia, const py::object& rotors, const Vector3d& omega,
                          const Quat& attitude) {
  std::vector<Rotor> wheels;
  for (const py::handle rotor : rotors) {
    const std::string where = "rotors[" + std::to_string(wheels.size()) + "]";
    wheels.push_back(to_rotor(rotor, where));
    if (!wheels.back().has_windows()) continue;
    throw InvalidInput(where, "one that always turns", "one with windows of time", "solve a Scene with such rotors");
  }
  const Scene scene(SceneParts{.inertia_B = inertia, .omega = omega, .times = {0.0}, .rotors = std::move(wheels)});
  return {scene.inertia_B(), scene.rotor_momentum(), omega, attitude};
}

Gyrostat make_gyrostat(py::handle inertia, const py::object& rotors, const py::object& momentum, py::handle omega,
                       py::handle attitude) {
  if (!rotors.is_none() && !momentum.is_none()) {
    throw InvalidInput("momentum", "given without rotors, or not at all", "both",
                       "momentum is the sum of all the rotors");
  }
  const Vector3d w = to_vector3(omega, "omega");
  const Quat q = to_attitude(attitude, "attitude");
  const InertiaTensor body = py::isinstance<InertiaTensor>(inertia)
                                 ? inertia.cast<const InertiaTensor&>()
                                 : InertiaTensor::from_moments(to_moments(inertia, "inertia"));
  if (!rotors.is_none() && py::len(rotors) > 0) return make_with_rotors(body, rotors, w, q);
  return {body, momentum.is_none() ? Vector3d::Zero() : to_vector3(momentum, "momentum"), w, q};
}

}  // namespace

template <>
void bind_closed_form<Gyrostat>(py::module_& m) {
  auto cls = make_class<Gyrostat>(m, "Gyrostat", R"(Torque-free motion of a rigid body with rotors, in closed form at any time.

Euler's equations are J omega' = (J omega + h) x omega with the rotors' momentum h constant in the body. One class for
every body and every h: near and on steady turns, separatrices and symmetries too. The error against the exact motion of
the same float64 input is a few units of rounding at every time. With h = 0 the answers are those of FreeMotion.

Parameters
----------
inertia : InertiaTensor, or array_like of shape (3,)
    About the centre of mass, in body axes, with the rotors locked [kg m^2]; three numbers are principal moments in the
    given axes, in any order. Beside `momentum` of rotors that are free on their bearings: less their axial parts.
rotors : sequence of Rotor, optional
    Held at a constant speed relative to the body, or free on their bearings, without windows of time.
momentum : array_like, shape (3,), optional
    In their place: the rotors' momentum h in body axes [kg m^2/s]. 0 if neither is given.
omega : array_like, shape (3,)
    Angular velocity of the body at t = 0, in body axes [rad/s].
attitude : array_like of shape (4,), or a Rotation
    Body to space at t = 0, (x, y, z, w).

Raises
------
InvalidInput
    Not finite, a body no mass makes, one without a moment about some axis, or an attitude that is not unit.

Notes
-----
Zhukovsky (1885); Volterra (1899), Acta Math. 22; Wittenburg (1977), Dynamics of Systems of Rigid Bodies; see
docs/gyrostat.md.)");
  cls.def(py::init(&make_gyrostat), py::arg("inertia"), py::kw_only(), py::arg("rotors") = py::none(),
          py::arg("momentum") = py::none(), py::arg("omega"), py::arg("attitude") = py::make_tuple(0, 0, 0, 1))
      .def("at", &at<Gyrostat>, py::arg("t"), at_doc(", up to abs(omega t) = 1e25 rad").c_str())
      .def("euler_angles", &along<Gyrostat, &Gyrostat::euler_angles>, py::arg("t"), euler_angles_doc("total").c_str())
      .def("polhode", &along<Gyrostat, &Gyrostat::polhode>, py::arg("t"),
           curve_doc("The total momentum in body axes.",
                     "J omega + h [kg m^2/s]: on a sphere about 0 and on an ellipsoid of constant energy about h.").c_str())
      .def_property_readonly(
          "kind", [](const Gyrostat& g) { return to_text(g.kind()); },
          "'rest', 'steady', 'precession', 'paired', 'single' or 'separatrix'.\n\n"
          "'steady': omega is constant. 'precession': omega runs on a circle at a constant rate. 'paired': there is\n"
          "a second curve of the same energy and momentum. 'single': there is none.")
      .def_property_readonly("period", &Gyrostat::period,
                             "Period of omega [s]: infinite on a separatrix, 0 where omega is constant.")
      .def_property_readonly("energy", &Gyrostat::energy, "omega . J omega / 2, constant [J].")
      .def_property_readonly(
          "angular_momentum", [](const Gyrostat& g) { return from_vector3(g.angular_momentum()); },
          "(3,) total momentum in space axes, constant [kg m^2/s].")
      .def_property_readonly(
          "momentum", [](const Gyrostat& g) { return from_vector3(g.momentum()); },
          "(3,) the rotors' momentum h in body axes [kg m^2/s].")
      .def("__hash__",
           [](const Gyrostat& g) { return hash_of(g.omega(), g.momentum()[0], g.momentum()[1], g.momentum()[2]); })
      .def("__repr__", [](const Gyrostat& g) {
        return call_text("Gyrostat", g, ", momentum=" + array_text(from_vector3(g.momentum())));
      });
  bind_start(cls, [](const Gyrostat& g) {
    Picture picture{.period = g.period()};
    if (!g.momentum().isZero(0.0))
      picture.rotors.append(Rotor({.axis = g.momentum(), .momentum = g.momentum().norm()}));
    return picture;
  });
  cls.def(py::pickle(
      [](const Gyrostat& g) {
        return py::make_tuple(g.inertia(), from_vector3(g.momentum()), from_vector3(g.omega()),
                              from_quat(g.attitude()));
      },
      [](const py::tuple& state) {
        return from_state("Gyrostat", state, 4, [](const py::tuple& s) {
          const auto inertia = s[0].cast<InertiaTensor>();
          return Gyrostat(inertia, to_vector3(s[1], "momentum"), to_vector3(s[2], "omega"), stored_attitude(s[3]));
        });
      }));
}

}  // namespace polhode::python
