#pragma once

#include <pybind11/operators.h>
#include <pybind11/typing.h>

#include <limits>
#include <string>
#include <vector>

#include "polhode/exact/closed_forms.hpp"
#include "convert.hpp"
#include "gil.hpp"
#include "polhode/core/state.hpp"
#include "polhode/scene/rotor.hpp"
#include "polhode/torque/torques.hpp"

// What the closed forms share on their way to Python.
namespace polhode::python {

/// Binds the class of a closed form; each is defined in its own file.
template <class Form>
void bind_closed_form(py::module_& m);
#define POLHODE_DECLARE(type) template <> void bind_closed_form<type>(py::module_& m);
POLHODE_CLOSED_FORM_TYPES(POLHODE_DECLARE)
#undef POLHODE_DECLARE

/// The base of the classes in Python, for what Python defines of all of them.
struct AnyForm {};

/// The class of a closed form, below the common base.
template <class Form>
py::class_<Form> make_class(py::module_& m, const char* name, const char* doc) {
  py::class_<Form> cls(m, name, m.attr("_ClosedForm"), doc);
  cls.attr("__module__") = "polhode";
  return cls;
}

/// The docstring of `at`. @param limit  behind "negative ones too"; @param raises  the text of InvalidInput
inline std::string at_doc(const std::string& limit, const std::string& raises = "", const std::string& options = "") {
  return "Angular velocity and attitude at the given times.\n\nParameters\n----------\nt : array_like, any shape\n"
         "    Times [s], negative ones too" + limit + ".\n" + options + R"(
Returns
-------
omega : ndarray, shape (..., 3)
    In body axes [rad/s].
attitude : ndarray, shape (..., 4)
    Body to space, unit, (x, y, z, w).)" + (raises.empty() ? "" : "\n\nRaises\n------\nInvalidInput\n    " + raises);
}

/// The docstring of a curve: its title, and what stands under "Returns".
inline std::string curve_doc(const std::string& title, const std::string& returns) {
  return title + "\n\nParameters\n----------\nt : array_like, any shape\n    Times [s].\n\nReturns\n-------\n"
         "ndarray, shape (..., 3)\n    " + returns;
}

inline std::string euler_angles_doc(const std::string& momentum) {
  return curve_doc("Angles about the " + momentum + " momentum.",
                   "(phi, theta, psi) [rad], intrinsic z-x-z of the body axes in a space frame whose z axis is the " +
                       momentum + " momentum\n    (space z turned there the shortest way): precession, nutation and "
                       "spin. phi and psi in [-pi, pi].");
}

/// The start in the docstring of a class.
#define POLHODE_START_DOC                                     \
  "omega : array_like, shape (3,)\n"                          \
  "    Angular velocity at t = 0, in body axes [rad/s].\n"        \
  "attitude : array_like of shape (4,), or a Rotation\n"       \
  "    Body to space at t = 0, (x, y, z, w).\n"

/// What a picture draws: the torques and rotors of the scene, its period [s] (0: none), and the longest span [s].
struct Picture {
  py::list torques = py::list(), rotors = py::list();
  double period = 0.0, longest = std::numeric_limits<double>::infinity();
};

/// A new array of shape t.shape + (width,).
inline Array result_for(const Array& t, py::ssize_t width) {
  std::vector<py::ssize_t> shape(t.shape(), t.shape() + t.ndim());
  shape.push_back(width);
  return Array(shape);
}

/// omega and attitude of a closed form at one time, or at an array of them with the GIL released.
template <class Motion>
py::typing::Tuple<Array, Array> at(const Motion& motion, py::handle t) {
  if (PyFloat_CheckExact(t.ptr())) {
    const State state = motion.at(PyFloat_AS_DOUBLE(t.ptr()));
    return py::make_tuple(from_vector3(state.omega), from_quat(state.attitude));
  }
  const Array times = to_array(t, "t");
  Array omega = result_for(times, 3), attitude = result_for(times, 4);
  const double* in = times.data();
  double *w = omega.mutable_data(), *q = attitude.mutable_data();
  const auto n = static_cast<std::size_t>(times.size());
  {
    const WithoutGil nogil;
    motion.at(in, n, w, q);
  }
  return py::make_tuple(omega, attitude);
}

/// A curve of a closed form: three numbers at each time, with the GIL released.
template <class Motion, Vector3d (Motion::*curve)(double) const>
Array along(const Motion& motion, py::handle t) {
  const Array times = to_array(t, "t");
  Array points = result_for(times, 3);
  const double* in = times.data();
  double* out = points.mutable_data();
  const py::ssize_t n = times.size();
  const WithoutGil nogil;
  for (py::ssize_t i = 0; i < n; ++i) {
    if (i % 1024 == 0) check_interrupt();
    Eigen::Map<Vector3d>(out + 3 * i) = (motion.*curve)(in[i]);
  }
  return points;
}

/// What a closed form started from, equality, and its picture. @param picture  makes the Picture of a motion
template <class Motion, class Make>
void bind_start(py::class_<Motion>& cls, const Make& picture, const char* inertia = "The InertiaTensor.") {
  cls.def_property_readonly("inertia", &Motion::inertia, inertia)
      .def_property_readonly(
          "omega", [](const Motion& motion) { return from_vector3(motion.omega()); },
          "(3,) omega at t = 0, in body axes [rad/s].")
      .def_property_readonly(
          "attitude", [](const Motion& motion) { return from_quat(motion.attitude()); }, "(4,) attitude at t = 0.")
      .def_property_readonly(
          "_picture",
          [picture](const Motion& motion) {
            const Picture drawn = picture(motion);
            return py::make_tuple(drawn.torques, drawn.rotors, drawn.period, drawn.longest);
          },
          "The torques and rotors of its scene, its period [s] or 0, the longest span to draw [s].")
      .def(py::self == py::self);
}

/// The call that makes this motion: `middle` stands between inertia and omega, `end` behind attitude.
template <class Motion>
std::string call_text(const char* name, const Motion& motion, const std::string& middle = "",
                      const std::string& end = "") {
  return std::string(name) + "(" + py::cast<std::string>(py::repr(py::cast(motion.inertia()))) + middle +
         ", omega=" + array_text(from_vector3(motion.omega())) +
         ", attitude=" + array_text(from_quat(motion.attitude())) + end + ")";
}

/// A hash of some of a motion's numbers.
template <class... Numbers>
py::ssize_t hash_of(const Vector3d& omega, Numbers... others) {
  return py::hash(py::make_tuple(others..., omega[0], omega[1], omega[2]));
}

/// The attitude in a pickle, as it was: to make it unit again could move it by a unit of rounding.
inline Quat stored_attitude(py::handle value) {
  const Array q = to_array_with_tail(value, "attitude", {4});
  return {q.data()[0], q.data()[1], q.data()[2], q.data()[3]};
}

}  // namespace polhode::python
