#include <pybind11/typing.h>

#include <vector>

#include "bind_exact.hpp"
#include "convert.hpp"
#include "polhode/core/error.hpp"
#include "polhode/exact/heavy_top.hpp"

namespace polhode::python {
namespace {

HeavyTop make_heavy_top(py::handle inertia, py::handle weight_arm, py::handle omega, py::handle attitude,
                        py::handle rotor) {
  const double arm = to_real(weight_arm, "weight_arm"), h = to_real(rotor, "rotor");
  const Vector3d w = to_vector3(omega, "omega");
  const Quat q = to_attitude(attitude, "attitude");
  if (py::isinstance<InertiaTensor>(inertia)) return {inertia.cast<const InertiaTensor&>(), arm, w, q, h};
  const Array array = to_array(inertia, "inertia");
  if (array.ndim() == 1 && array.shape(0) == 3) return {to_vector3(array, "inertia"), arm, w, q, h};
  return {InertiaTensor(to_tensor(array, "inertia")), arm, w, q, h};
}

}  // namespace

template <>
void bind_closed_form<HeavyTop>(py::module_& m) {
  auto cls = make_class<HeavyTop>(m, "HeavyTop", R"(Lagrange's top: a symmetric body held at a point of its axis, under gravity.

In closed form at any time: looping, cuspidal and monotone precession, both steady precessions, sleeping and hanging
tops on both sides of stability, planar and spherical pendulums, next to and on the homoclinic motion. The error against
the exact motion of the same float64 input is a few units of rounding at every time.

Parameters
----------
inertia : array_like of shape (3,), InertiaTensor, or array_like of shape (3, 3)
    About the pivot, in body axes, two moments equal [kg m^2]; three numbers are moments along the body axes. The
    symmetry axis is body z for (A, A, C); else the axis of the third moment, its largest component positive.
weight_arm : float
    Mass times gravity times the distance of the centre of mass from the pivot, signed along the symmetry axis [N m].
    Gravity points along -z of space.
)" POLHODE_START_DOC R"(rotor : float, optional
    Momentum of rotors about the symmetry axis, constant in the body [kg m^2/s], as of a toy gyroscope's wheel. The
    inertia is then as for Gyrostat.

Raises
------
InvalidInput
    Not finite, a body no mass makes, no two moments equal, an attitude that is not unit, or rates beyond float64.

Notes
-----
F. Klein and A. Sommerfeld, "Ueber die Theorie des Kreisels" (1897-1910); see docs/heavy_top.md.)");
  cls.def(py::init(&make_heavy_top), py::arg("inertia"), py::arg("weight_arm"), py::arg("omega"),
          py::arg("attitude") = py::make_tuple(0, 0, 0, 1), py::arg("rotor") = 0.0)
      .def("at", &at<HeavyTop>, py::arg("t"), at_doc(", up to abs(omega t) = 1e25 rad", "A time that is not finite, or too long for its phase to have digits.").c_str())
      .def_property_readonly("kind", [](const HeavyTop& top) { return to_text(top.kind()); },
                             "'free' (no weight), 'sleeping', 'hanging', 'steady_precession', 'planar_pendulum',\n"
                             "'spherical_pendulum', 'homoclinic', 'looping', 'cuspidal' or 'monotone'.")
      .def_property_readonly("nutation_period", &HeavyTop::nutation_period,
                             "Period of the tilt [s]: infinite for 'homoclinic', 0 where the tilt is constant.")
      .def_property_readonly("tilt_bounds",
                             [](const HeavyTop& top) { return py::make_tuple(top.tilt_min(), top.tilt_max()); },
                             "(least, greatest) angle between the symmetry axis and space z [rad].")
      .def_property_readonly("precession_rate", &HeavyTop::precession_rate,
                             "Mean rate of the axis about space z over a nutation [rad/s]. NaN for an axis that\n"
                             "stays vertical, and for 'homoclinic'.")
      .def_property_readonly("energy", &HeavyTop::energy,
                             "Kinetic energy without that inside rotors, and weight_arm cos(tilt) [J].")
      .def_property_readonly("p_phi", &HeavyTop::p_phi, "Angular momentum about space z, with rotors [kg m^2/s].")
      .def_property_readonly("p_psi", &HeavyTop::p_psi,
                             "Angular momentum about the symmetry axis, with rotors [kg m^2/s].")
      .def_property_readonly("axis", [](const HeavyTop& top) { return from_vector3(top.axis()); },
                             "(3,) the symmetry axis in body axes, unit.")
      .def_property_readonly("weight_arm", &HeavyTop::weight_arm, "Signed along the symmetry axis [N m].")
      .def_property_readonly("rotor", &HeavyTop::rotor, "Momentum of rotors about the symmetry axis [kg m^2/s].")
      .def("__hash__", [](const HeavyTop& top) { return hash_of(top.omega(), top.weight_arm()); })
      .def("__repr__", [](const HeavyTop& top) {
        return call_text("HeavyTop", top, ", weight_arm=" + to_text(top.weight_arm()),
                         top.rotor() == 0.0 ? "" : ", rotor=" + to_text(top.rotor()));
      });
  bind_start(cls, [](const HeavyTop& top) {
    Picture picture{.period = top.nutation_period()};
    if (top.weight_arm() != 0.0) picture.torques.append(torques::Gravity(1.0, top.axis() * top.weight_arm()));
    if (top.rotor() != 0.0) picture.rotors.append(Rotor({.axis = top.axis(), .momentum = top.rotor()}));
    return picture;
  }, "The InertiaTensor about the pivot.");
  cls.def(py::pickle(
      [](const HeavyTop& top) {
        return py::make_tuple(top.inertia(), top.weight_arm(), from_vector3(top.omega()), from_quat(top.attitude()),
                              top.rotor());
      },
      [](const py::tuple& state) {
        return from_state("HeavyTop", state, 5, [](const py::tuple& s) {
          const auto inertia = s[0].cast<InertiaTensor>();
          return HeavyTop(inertia, to_real(s[1], "weight_arm"), to_vector3(s[2], "omega"), stored_attitude(s[3]),
                          to_real(s[4], "rotor"));
        });
      }));
}

}  // namespace polhode::python
