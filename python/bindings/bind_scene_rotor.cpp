#include <pybind11/stl.h>

#include "bind_formula.hpp"
#include "bind_scene.hpp"
#include "convert.hpp"
#include "polhode/core/error.hpp"
#include "polhode/scene/rotor.hpp"

// polhode.Rotor: a wheel in a body.
namespace polhode::python {
namespace {

using formula::Input;
using formula::Text;

std::optional<double> to_optional(py::handle value, const char* name) {
  if (value.is_none()) return std::nullopt;
  return to_real(value, name);
}

std::optional<std::vector<torques::Window>> to_optional_windows(py::handle during) {
  if (during.is_none()) return std::nullopt;
  return to_windows(during, "Rotor.during");
}

double to_number(py::handle value, const char* name) { return value.is_none() ? 0.0 : to_real(value, name); }

/// The motor of a text, of a function, or of a pickle.
Text to_motor(py::handle torque, py::handle let, const py::dict& parameters) {
  if (py::isinstance<py::tuple>(torque)) {
    const py::tuple state = py::reinterpret_borrow<py::tuple>(torque);
    return {state[0].cast<std::string>(), from_pairs(state[2]), {}, {}, from_text_pairs(state[1])};
  }
  const std::vector<Input> inputs = to_inputs(parameters, "Rotor.parameters.");
  if (py::isinstance<py::str>(torque))
    return {to_field(torque, "Rotor.torque"), inputs, {}, {}, to_let(let, "Rotor.let")};
  if (!let.is_none()) throw InvalidInput("Rotor.let", "left out for a function", std::string(py::repr(let)));
  const py::module_ trace = py::module_::import("polhode._formula.trace");
  return take_motor(trace.attr("trace_motor")(torque, from_inputs(inputs)).cast<const Text&>());
}

void set_torque(py::handle torque, py::handle let, py::handle parameters, RotorParts& parts) {
  if (!parameters.is_none() && !py::isinstance<py::dict>(parameters))
    throw InvalidInput("Rotor.parameters", "a dict of names and numbers", std::string(py::repr(parameters)));
  const py::dict own = parameters.is_none() ? py::dict() : py::reinterpret_borrow<py::dict>(parameters);
  if (py::isinstance<py::tuple>(torque) || py::isinstance<py::str>(torque) || PyCallable_Check(torque.ptr())) {
    parts.law = to_motor(torque, let, own);
    return;
  }
  parts.torque = to_number(torque, "Rotor.torque");
  if (own.size() > 0)
    throw InvalidInput("Rotor.parameters", "left out for a torque that is a number", std::string(py::repr(own)));
  if (!let.is_none())
    throw InvalidInput("Rotor.let", "left out for a torque that is a number", std::string(py::repr(let)));
}

Rotor make_rotor(py::handle axis, py::handle momentum, py::handle inertia, py::handle speed, py::handle free,
                 py::handle during, py::handle torque, py::handle viscous, py::handle coulomb, py::handle max_torque,
                 py::handle max_speed, py::handle let, py::handle parameters) {
  const Array direction = to_array(axis, "Rotor.axis");
  if (direction.ndim() != 1 || direction.size() != 3)
    throw InvalidInput("Rotor.axis", "three numbers", "shape " + std::string(py::str(direction.attr("shape"))));
  if (!py::isinstance<py::bool_>(free)) throw InvalidInput("Rotor.free", "True or False", std::string(py::repr(free)));
  RotorParts parts{.axis = {direction.data()[0], direction.data()[1], direction.data()[2]},
                   .momentum = to_optional(momentum, "Rotor.momentum"),
                   .inertia = to_optional(inertia, "Rotor.inertia"),
                   .speed = to_optional(speed, "Rotor.speed"),
                   .free = free.cast<bool>(),
                   .windows = to_optional_windows(during),
                   .viscous = to_number(viscous, "Rotor.viscous"),
                   .coulomb = to_number(coulomb, "Rotor.coulomb"),
                   .max_torque = to_optional(max_torque, "Rotor.max_torque"),
                   .max_speed = to_optional(max_speed, "Rotor.max_speed")};
  set_torque(torque, let, parameters, parts);
  return Rotor(std::move(parts));
}

/// A number, or the formula as (text, shared parts, parameters).
py::object get_torque(const Rotor& rotor) {
  const RotorParts& parts = rotor.parts();
  if (!parts.law) return py::float_(parts.torque);
  return py::make_tuple(parts.law->torque, to_text_pairs(parts.law->let), to_pairs(parts.law->parameters));
}

py::object get_during(const Rotor& rotor) {
  if (!rotor.has_windows()) return py::none();
  return from_windows(rotor.windows());
}

py::tuple get_state(const Rotor& rotor) {
  const Vector3d& a = rotor.axis();
  return py::make_tuple(py::make_tuple(a[0], a[1], a[2]), rotor.momentum(), rotor.inertia(), rotor.speed(),
                        rotor.free(), get_during(rotor), get_torque(rotor), rotor.parts().viscous, rotor.parts().coulomb,
                        rotor.parts().max_torque, rotor.parts().max_speed);
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
  const RotorParts& parts = rotor.parts();
  if (parts.law) {
    text.append(", torque=").append(py::repr(py::str(parts.law->torque)));
    if (!parts.law->let.empty()) text.append(", let=").append(py::repr(from_let(parts.law->let)));
    if (!parts.law->parameters.empty())
      text.append(", parameters=").append(py::repr(from_inputs(parts.law->parameters)));
  } else if (parts.torque != 0.0) {
    text.append(", torque=").append(py::repr(state[6]));
  }
  if (parts.viscous != 0.0) text.append(", viscous=").append(py::repr(state[7]));
  if (parts.coulomb != 0.0) text.append(", coulomb=").append(py::repr(state[8]));
  if (parts.max_torque) text.append(", max_torque=").append(py::repr(state[9]));
  if (parts.max_speed) text.append(", max_speed=").append(py::repr(state[10]));
  return text + ")";
}

constexpr const char* rotor_doc =
    "Rotor(axis, *, momentum=None, inertia=None, speed=None, free=False, during=None, torque=0.0, viscous=0.0, "
    R"doc(coulomb=0.0, max_torque=None, max_speed=None, let=..., parameters=...)

A symmetric rotor on an axis fixed in the body: a wheel, a propeller, a spinning platform.

Euler's equations of the body become ``J omega' + omega x (J omega + h) = torque``. All rotors of a scene together give
h. The inertia of a scene always includes its rotors, locked. A rotor that a motor holds at a constant relative speed
leaves J as it is, and ``h = inertia * speed * axis``. A rotor that is free on its bearing has a constant absolute
momentum about its axis, ``inertia * (speed + axis . omega)``. J is then less its axial moment.

A motor and friction change the momentum of a free rotor by their torque e about the axis, and -e acts on the body:
``inertia * (speed' + axis . omega') = e``, with ``e = torque - viscous * speed - coulomb * sign(speed)``. The momentum
is then a state of the motion, ``motion.states["rotor_momentum_0"]`` of the first rotor of a scene.

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
torque : float, str or callable, optional
    Torque of a motor on a free rotor about its axis [N m]. It is a number; a text such as
    ``"0.2 * omega.x - 0.01 * speed"`` of t, omega, attitude and speed [rad/s]; or ``torque(t, omega, attitude, p, s)``,
    which is traced once, with ``s.speed``. Texts have the words of `polhode.torques.Formula`.
viscous : float, optional
    Viscous friction of a free rotor's bearing [N m s].
coulomb : float, optional
    Dry friction of a free rotor's bearing [N m].
max_torque : float, optional
    The motor's torque is cut to this size [N m].
max_speed : float, optional
    The motor does not drive the rotor beyond this speed, in both senses [rad/s].
let : dict of str, optional
    Names for shared parts of a text, in order.
parameters : dict, optional
    Named numbers of a text or a function, ``p.kd`` in a function.

Raises
------
InvalidInput
    For an axis that is zero or not finite, numbers that are not finite, an inertia that is not positive, too many or
    too few numbers, and windows of a free rotor. For a motor or friction of a held rotor or of one without an inertia,
    and friction that is negative.

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
      .def(py::init([](py::handle axis, py::handle momentum, py::handle inertia, py::handle speed, py::handle free,
                       py::handle during, py::handle torque, py::handle viscous, py::handle coulomb,
                       py::handle max_torque, py::handle max_speed, py::handle let, py::handle parameters) {
             if (py::isinstance<py::tuple>(torque))   // the form of pickles
               throw InvalidInput("Rotor.torque", "a number, a text or a function", std::string(py::repr(torque)));
             return make_rotor(axis, momentum, inertia, speed, free, during, torque, viscous, coulomb, max_torque,
                               max_speed, let, parameters);
           }), py::arg("axis"), py::kw_only(), py::arg("momentum") = py::none(),
           py::arg("inertia") = py::none(), py::arg("speed") = py::none(), py::arg("free") = false,
           py::arg("during") = py::none(), py::arg("torque") = 0.0, py::arg("viscous") = 0.0,
           py::arg("coulomb") = 0.0, py::arg("max_torque") = py::none(), py::arg("max_speed") = py::none(),
           py::arg("let") = py::none(), py::arg("parameters") = py::none())
      .def_property_readonly("axis", [](const Rotor& rotor) { return from_vector3(rotor.axis()); },
                             "Unit vector in body axes, shape (3,).")
      .def_property_readonly("momentum", &Rotor::momentum, "As given [kg m^2/s], or None.")
      .def_property_readonly("inertia", &Rotor::inertia, "Moment about the axis [kg m^2], or None.")
      .def_property_readonly("speed", &Rotor::speed, "Relative to the body at the start [rad/s], or None.")
      .def_property_readonly("free", &Rotor::free, "True if it is free on its bearing.")
      .def_property_readonly("during", &get_during, "tuple of (begin, end) [s], in the order of time; None if it always rotates.")
      .def_property_readonly("torque", [](const Rotor& rotor) -> py::object {
        if (rotor.parts().law) return py::str(rotor.parts().law->torque);
        return py::float_(rotor.parts().torque);
      }, "Of the motor about the axis [N m]: a number, or the text of its formula.")
      .def_property_readonly("let", [](const Rotor& rotor) {
        return rotor.parts().law ? from_let(rotor.parts().law->let) : py::dict();
      }, "Shared parts of the motor's formula by name.")
      .def_property_readonly("parameters", [](const Rotor& rotor) {
        return rotor.parts().law ? from_inputs(rotor.parts().law->parameters) : py::dict();
      }, "Numbers of the motor's formula by name.")
      .def_property_readonly("viscous", [](const Rotor& rotor) { return rotor.parts().viscous; },
                             "Viscous friction of the bearing [N m s].")
      .def_property_readonly("coulomb", [](const Rotor& rotor) { return rotor.parts().coulomb; },
                             "Dry friction of the bearing [N m].")
      .def_property_readonly("max_torque", [](const Rotor& rotor) { return rotor.parts().max_torque; },
                             "The most that the motor gives [N m], or None.")
      .def_property_readonly("max_speed", [](const Rotor& rotor) { return rotor.parts().max_speed; },
                             "The speed beyond which the motor does not drive [rad/s], or None.")
      .def("__repr__", &show)
      .def("__eq__",
           [](const Rotor& a, const py::object& b) {
             return py::isinstance<Rotor>(b) && get_state(a).equal(get_state(b.cast<const Rotor&>()));
           })
      .def("__hash__", [](const Rotor& rotor) { return py::hash(get_state(rotor)); })
      .def(py::pickle(&get_state, [](const py::tuple& state) {
        if (state.size() == 6)   // of earlier versions, without motors
          return make_rotor(state[0], state[1], state[2], state[3], state[4], state[5], py::none(), py::none(),
                            py::none(), py::none(), py::none(), py::none(), py::none());
        return make_rotor(state[0], state[1], state[2], state[3], state[4], state[5], state[6], state[7], state[8],
                          state[9], state[10], py::none(), py::none());
      }));
}

}  // namespace polhode::python
