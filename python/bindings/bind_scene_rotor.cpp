#include <pybind11/stl.h>

#include "bind_scene.hpp"
#include "convert.hpp"
#include "polhode/core/error.hpp"
#include "polhode/scene/rotor.hpp"

// polhode.Rotor: a wheel in a body.
namespace polhode::python {
namespace {

std::optional<double> to_optional(py::handle value, const char* name) {
  if (value.is_none()) return std::nullopt;
  return to_real(value, name);
}

std::optional<std::vector<torques::Window>> to_optional_windows(py::handle during) {
  if (during.is_none()) return std::nullopt;
  return to_windows(during, "Rotor.during");
}

Rotor make_rotor(py::handle axis, py::handle momentum, py::handle inertia, py::handle speed, py::handle free,
                 py::handle during) {
  const Array direction = to_array(axis, "Rotor.axis");
  if (direction.ndim() != 1 || direction.size() != 3)
    throw InvalidInput("Rotor.axis", "three numbers", "shape " + std::string(py::str(direction.attr("shape"))));
  if (!py::isinstance<py::bool_>(free)) throw InvalidInput("Rotor.free", "True or False", std::string(py::repr(free)));
  return Rotor({.axis = {direction.data()[0], direction.data()[1], direction.data()[2]},
                .momentum = to_optional(momentum, "Rotor.momentum"),
                .inertia = to_optional(inertia, "Rotor.inertia"),
                .speed = to_optional(speed, "Rotor.speed"),
                .free = free.cast<bool>(),
                .windows = to_optional_windows(during)});
}

py::object get_during(const Rotor& rotor) {
  if (!rotor.has_windows()) return py::none();
  return from_windows(rotor.windows());
}

py::tuple get_state(const Rotor& rotor) {
  const Vector3d& a = rotor.axis();
  return py::make_tuple(py::make_tuple(a[0], a[1], a[2]), rotor.momentum(), rotor.inertia(), rotor.speed(),
                        rotor.free(), get_during(rotor));
}

std::string show(const Rotor& rotor) {
  const py::tuple state = get_state(rotor);
  std::string text = "polhode.Rotor(" + std::string(py::repr(state[0]));
  constexpr const char* names[] = {"momentum", "inertia", "speed"};
  for (std::size_t i = 0; i < 3; ++i) {
    if (!state[i + 1].is_none()) text.append(", ").append(names[i]).append("=").append(py::repr(state[i + 1]));
  }
  if (rotor.free()) text += ", free=True";
  if (!state[5].is_none()) text.append(", during=").append(py::repr(state[5]));
  return text + ")";
}

constexpr const char* rotor_doc =
    R"doc(Rotor(axis, *, momentum=None, inertia=None, speed=None, free=False, during=None)

A symmetric rotor on an axis fixed in the body: a wheel, a propeller, a spinning platform.

Euler's equations of the body become ``J omega' + omega x (J omega + h) = torque``. All rotors of a scene together give
h. The inertia of a scene always includes its rotors, locked. A rotor that a motor holds at a constant relative speed
leaves J as it is, and ``h = inertia * speed * axis``. A rotor that is free on its bearing has a constant absolute
momentum about its axis, ``inertia * (speed + axis . omega)``. J is then less its axial moment.

Parameters
----------
axis : array_like, shape (3,)
    Direction in body axes. It is divided by its length.
momentum : float, optional
    Angular momentum about the axis [kg m^2/s]. Held: relative to the body. Free: absolute.
inertia : float, optional
    Moment of inertia about the axis [kg m^2].
speed : float, optional
    Speed relative to the body at the start [rad/s]. Give `momentum`, or `inertia` and `speed`, or `momentum` and
    `inertia`.
free : bool
    True if no motor holds the speed. Without `inertia`, the scene's inertia must leave out the axial moment already.
during : array_like, shape (n, 2) or (2,), optional
    Windows of time [s] in which a held rotor rotates; outside them it is at rest in the body. An
    empty list means never, no list means always. J omega + h is continuous
    where it starts or stops, so omega jumps by ``-J^-1 dh``.

Raises
------
InvalidInput
    For an axis that is zero or not finite, numbers that are not finite, an inertia that is not positive, too many or
    too few numbers, and windows of a free rotor.

Notes
-----
Wittenburg 1977, Dynamics of Systems of Rigid Bodies, sec. 4.6; Hughes 1986, Spacecraft Attitude Dynamics, ch. 6.
)doc";

}  // namespace

Rotor to_rotor(py::handle value, const std::string& name) {
  if (!py::isinstance<Rotor>(value)) throw InvalidInput(name, "a polhode.Rotor", std::string(py::repr(value)));
  return value.cast<const Rotor&>();
}

void bind_scene_rotor(py::module_& m) {
  py::class_<Rotor>(m, "Rotor", rotor_doc)
      .def(py::init(&make_rotor), py::arg("axis"), py::kw_only(), py::arg("momentum") = py::none(),
           py::arg("inertia") = py::none(), py::arg("speed") = py::none(), py::arg("free") = false,
           py::arg("during") = py::none())
      .def_property_readonly("axis", [](const Rotor& rotor) { return from_vector3(rotor.axis()); },
                             "Unit vector in body axes, shape (3,).")
      .def_property_readonly("momentum", &Rotor::momentum, "As given [kg m^2/s], or None.")
      .def_property_readonly("inertia", &Rotor::inertia, "Moment about the axis [kg m^2], or None.")
      .def_property_readonly("speed", &Rotor::speed, "Relative to the body at the start [rad/s], or None.")
      .def_property_readonly("free", &Rotor::free, "True if it is free on its bearing.")
      .def_property_readonly("during", &get_during, "tuple of (begin, end) [s], in the order of time; None if it always rotates.")
      .def("__repr__", &show)
      .def("__eq__",
           [](const Rotor& a, const py::object& b) {
             return py::isinstance<Rotor>(b) && get_state(a).equal(get_state(b.cast<const Rotor&>()));
           })
      .def("__hash__", [](const Rotor& rotor) { return py::hash(get_state(rotor)); })
      .def(py::pickle(&get_state, [](const py::tuple& state) {
        return make_rotor(state[0], state[1], state[2], state[3], state[4], state[5]);
      }));
}

}  // namespace polhode::python
