#include <pybind11/typing.h>

#include "bind_exact.hpp"
#include "convert.hpp"
#include "polhode/core/error.hpp"
#include "polhode/exact/damped_free.hpp"

namespace polhode::python {
namespace {

DampedFree make_damped_free(py::handle inertia, py::handle damping, py::handle omega, py::handle attitude) {
  const double rate = to_real(damping, "damping");
  const Vector3d w = to_vector3(omega, "omega");
  const Quat q = to_attitude(attitude, "attitude");
  if (py::isinstance<InertiaTensor>(inertia)) return {inertia.cast<const InertiaTensor&>(), rate, w, q};
  return {to_vector3(inertia, "inertia"), rate, w, q};
}

}  // namespace

template <>
void bind_closed_form<DampedFree>(py::module_& m) {
  auto cls = make_class<DampedFree>(m, "DampedFree", R"(A free body with damping proportional to its angular momentum, -c I omega.

In closed form at any time, for any body: it is the free motion in the slowed time s = (1 - exp(-c t)) / c, with omega
multiplied by exp(-c t). The error is that of FreeMotion.

Parameters
----------
inertia : InertiaTensor, or array_like of shape (3,)
    About the centre of mass (or a fixed point), in body axes [kg m^2]; three numbers are principal moments in the given
    axes, in any order.
damping : float
    The rate c [1/s]. A negative rate drives the body.
)" POLHODE_START_DOC R"(
Raises
------
InvalidInput
    Not finite, a body no mass makes, one without a moment about some axis, or an attitude that is not unit.

Notes
-----
A change of time in Euler's equations; see docs/damped_free.md.)");
  cls.def(py::init(&make_damped_free), py::arg("inertia"), py::arg("damping"), py::arg("omega"),
          py::arg("attitude") = py::make_tuple(0, 0, 0, 1))
      .def("at", &at<DampedFree>, py::arg("t"), at_doc("", "A time that is not finite, or at which a driven body is beyond float64.").c_str())
      .def("slowed_time", &DampedFree::slowed_time, py::arg("t"), R"(The time at which the free body has this attitude.

Parameters
----------
t : float
    Time [s].

Returns
-------
float
    (1 - exp(-c t)) / c [s].)")
      .def_property_readonly("total_angle", &DampedFree::total_angle,
                             "Bound on the angle of rotation from t = 0 on, abs(omega) / c [rad]; infinite for c <= 0.")
      .def_property_readonly("free", &DampedFree::free, "The FreeMotion in slowed time.")
      .def_property_readonly("damping", &DampedFree::damping, "The rate c [1/s].")
      .def("__hash__", [](const DampedFree& f) { return hash_of(f.omega(), f.damping()); })
      .def("__repr__",
           [](const DampedFree& f) { return call_text("DampedFree", f, ", damping=" + to_text(f.damping())); });
  bind_start(cls, [](const DampedFree& f) {
    return Picture{.torques = py::make_tuple(torques::AngularDamping(f.damping())),
                   .longest = f.damping() > 0.0 ? 5.0 / f.damping() : std::numeric_limits<double>::infinity()};
  });
  cls.def(py::pickle(
      [](const DampedFree& f) {
        return py::make_tuple(f.inertia(), f.damping(), from_vector3(f.omega()), from_quat(f.attitude()));
      },
      [](const py::tuple& state) {
        return from_state("DampedFree", state, 4, [](const py::tuple& s) {
          const auto inertia = s[0].cast<InertiaTensor>();
          return DampedFree(inertia, to_real(s[1], "damping"), to_vector3(s[2], "omega"), stored_attitude(s[3]));
        });
      }));
}

}  // namespace polhode::python
