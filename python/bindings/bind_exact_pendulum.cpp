#include <pybind11/typing.h>

#include "bind_exact.hpp"
#include "convert.hpp"
#include "polhode/core/error.hpp"
#include "polhode/exact/pendulum.hpp"

namespace polhode::python {
namespace {

Pendulum make_pendulum(py::handle inertia, py::handle weight, py::handle arm, py::handle omega, py::handle attitude) {
  const double mg = to_real(weight, "weight");
  const Vector3d r = to_vector3(arm, "arm"), w = to_vector3(omega, "omega");
  const Quat q = to_attitude(attitude, "attitude");
  if (py::isinstance<InertiaTensor>(inertia)) return {inertia.cast<const InertiaTensor&>(), mg, r, w, q};
  return {InertiaTensor::from_moments(to_vector3(inertia, "inertia")), mg, r, w, q};
}

}  // namespace

template <>
void bind_closed_form<Pendulum>(py::module_& m) {
  auto cls = make_class<Pendulum>(m, "Pendulum", R"(The plane pendulum: any body on a pivot under gravity that swings about one body axis.

In closed form at any time and at every energy: swings of any size, rotation over the top, the separatrix between them,
rest. The axis may be any of the three body axes. It must be principal, horizontal and at right angles to the arm, and
omega must lie along it. These conditions are tested exactly. The error against the exact motion of the same float64
input is a few units of rounding at every time.

Parameters
----------
inertia : InertiaTensor, or array_like of shape (3,)
    About the pivot, in body axes [kg m^2]; three numbers are principal moments in the given axes, in any order.
weight : float
    m g [N]. Gravity points along -z of space.
arm : array_like, shape (3,)
    From the pivot to the centre of mass, in body axes [m].
)" POLHODE_START_DOC R"(
Raises
------
InvalidInput
    Not finite, a body no mass makes, an attitude that is not unit, or no plane pendulum, with the reason.

Notes
-----
E. T. Whittaker, "Analytical Dynamics" (1937), section 44; see docs/pendulum.md.)");
  cls.def(py::init(&make_pendulum), py::arg("inertia"), py::arg("weight"), py::arg("arm"), py::arg("omega"),
          py::arg("attitude") = py::make_tuple(0, 0, 0, 1))
      .def("at", &at<Pendulum>, py::arg("t"), at_doc(", up to 1e25 rad", "A time that is not finite, or too long for its phase to have digits.").c_str())
      .def_property_readonly("kind", [](const Pendulum& p) { return to_text(p.kind()); },
                             "'rest', 'swinging', 'rotating' or 'separatrix'.")
      .def_property_readonly("period", &Pendulum::period,
                             "Period of the rate [s]: infinite on the separatrix, 0 at rest.")
      .def_property_readonly("frequency", &Pendulum::frequency,
                             "Angular frequency of small swings, sqrt(m g r / I) [rad/s].")
      .def_property_readonly("axis", [](const Pendulum& p) { return from_vector3(p.axis()); },
                             "(3,) the axis of rotation in body axes, with omega along it.")
      .def_property_readonly("weight", &Pendulum::weight, "m g [N].")
      .def_property_readonly("arm", [](const Pendulum& p) { return from_vector3(p.arm()); },
                             "(3,) from the pivot to the centre of mass, in body axes [m].")
      .def("__hash__", [](const Pendulum& p) { return hash_of(p.omega(), p.weight()); })
      .def("__repr__", [](const Pendulum& p) {
        return call_text("Pendulum", p,
                         ", weight=" + to_text(p.weight()) + ", arm=" + array_text(from_vector3(p.arm())));
      });
  bind_start(cls, [](const Pendulum& p) {
    return Picture{.torques = py::make_tuple(torques::Gravity(p.weight(), p.arm())), .period = p.period()};
  }, "The InertiaTensor about the pivot.");
  cls.def(py::pickle(
      [](const Pendulum& p) {
        return py::make_tuple(p.inertia(), p.weight(), from_vector3(p.arm()), from_vector3(p.omega()),
                              from_quat(p.attitude()));
      },
      [](const py::tuple& state) {
        return from_state("Pendulum", state, 5, [](const py::tuple& s) {
          const auto inertia = s[0].cast<InertiaTensor>();
          return Pendulum(inertia, to_real(s[1], "weight"), to_vector3(s[2], "arm"), to_vector3(s[3], "omega"),
                          stored_attitude(s[4]));
        });
      }));
}

}  // namespace polhode::python
