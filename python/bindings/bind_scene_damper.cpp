#include <pybind11/stl.h>

#include "bind_scene.hpp"
#include "convert.hpp"
#include "polhode/core/error.hpp"
#include "polhode/scene/damper.hpp"

// polhode.Damper: a viscous slug in a body.
namespace polhode::python {
namespace {

Damper make_damper(py::handle inertia, py::handle viscous, py::handle rates) {
  return Damper(to_real(inertia, "Damper.inertia"), to_real(viscous, "Damper.viscous"),
                to_vector3(to_array(rates, "Damper.rates"), "Damper.rates"));
}

py::tuple get_damper_state(const Damper& damper) {
  const Vector3d& rates = damper.rates();
  return py::make_tuple(damper.inertia(), damper.viscous(), py::make_tuple(rates[0], rates[1], rates[2]));
}

constexpr const char* damper_doc =
    R"doc(Damper(*, inertia, viscous, rates=(0, 0, 0))

A viscous slug: a sphere in a cavity of the body, full of a viscous fluid.

With the rates sigma of the sphere relative to the body, the torque ``viscous * sigma`` acts on the body, and its opposite
on the sphere: ``inertia * (sigma' + omega' + omega x sigma) = -viscous * sigma``. The inertia of a scene includes the
sphere, locked. Its momentum ``inertia * (omega + sigma)`` is a state of the motion, ``motion.states["damper_momentum"]``.

Parameters
----------
inertia : float
    Moment of the sphere about its centre [kg m^2].
viscous : float
    Damping between sphere and body [N m s].
rates : array_like, shape (3,), optional
    Rates relative to the body at the start, body axes [rad/s].

Raises
------
InvalidInput
    For an inertia that is not positive, a negative damping, and numbers that are not finite.

Notes
-----
Kane and Levinson 1985, Dynamics: Theory and Applications; Hughes 1986, Spacecraft Attitude Dynamics, sec. 3.7.
)doc";

}  // namespace

std::optional<Damper> to_damper(py::handle value) {
  if (value.is_none()) return std::nullopt;
  if (!py::isinstance<Damper>(value))
    throw InvalidInput("scene.damper", "a polhode.Damper or None", std::string(py::repr(value)));
  return value.cast<const Damper&>();
}

void bind_scene_damper(py::module_& m) {
  py::class_<Damper>(m, "Damper", damper_doc)
      .def(py::init(&make_damper), py::kw_only(), py::arg("inertia"), py::arg("viscous"),
           py::arg("rates") = py::make_tuple(0.0, 0.0, 0.0))
      .def_property_readonly("inertia", &Damper::inertia, "Moment of the sphere about its centre [kg m^2].")
      .def_property_readonly("viscous", &Damper::viscous, "Damping between sphere and body [N m s].")
      .def_property_readonly("rates", [](const Damper& damper) { return from_vector3(damper.rates()); },
                             "Relative to the body at the start, shape (3,) [rad/s].")
      .def("__repr__", [](const Damper& damper) {
        const py::tuple state = get_damper_state(damper);
        return "polhode.Damper(inertia=" + std::string(py::repr(state[0])) + ", viscous=" +
               std::string(py::repr(state[1])) + ", rates=" + std::string(py::repr(state[2])) + ")";
      })
      .def("__eq__",
           [](const Damper& a, const py::object& b) {
             return py::isinstance<Damper>(b) && get_damper_state(a).equal(get_damper_state(b.cast<const Damper&>()));
           })
      .def("__hash__", [](const Damper& damper) { return py::hash(get_damper_state(damper)); })
      .def(py::pickle(&get_damper_state,
                      [](const py::tuple& state) { return make_damper(state[0], state[1], state[2]); }));
}

}  // namespace polhode::python
