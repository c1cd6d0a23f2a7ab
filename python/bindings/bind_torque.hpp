#pragma once

#include <array>
#include <atomic>
#include <optional>
#include <type_traits>

#include "bind.hpp"
#include "bind_scene.hpp"
#include "convert.hpp"
#include "polhode/core/error.hpp"
#include "polhode/torque/torques.hpp"

namespace polhode::python {

/// An array lent to a callable and used again for its next call, unless the callable kept it (or a view of it).
class LentArray {
 public:
  explicit LentArray(py::ssize_t size) : size_(size) {}
  ~LentArray() { Py_XDECREF(free_.load()); }

  /// Taken out while it is lent, so that neither a call within the call nor another thread can write into it.
  py::object take(const double* values);
  void give_back(py::object array) {
    if (array.ref_count() == 1) Py_XDECREF(free_.exchange(array.release().ptr()));
  }

 private:
  py::ssize_t size_;
  std::atomic<PyObject*> free_{nullptr};
};

/// A Custom torque as a Python object, which alone owns what Python gave. Copies of `torque` hold plain pointers here:
/// every object of Python that has such a copy keeps this object alive by a reference of its own. So the collector of
/// garbage sees each reference once.
struct OwnCustom {
  py::object function, potential, data;
  torques::Custom::Claims claims;
  LentArray omega{3}, attitude{4};
  std::optional<torques::Custom> torque;

  const torques::Custom& get() const { return *torque; }
  auto references() { return std::array{&function, &potential, &data}; }
};

/// A During as a Python object, which keeps the torque alive that it was made of.
struct OwnDuring {
  py::object inner;
  torques::During torque;

  const torques::During& get() const { return torque; }
  auto references() { return std::array{&inner}; }
};

/// The C++ type behind the Python class of a torque.
template <class T>
using Bound = std::conditional_t<std::is_same_v<T, torques::Custom>, OwnCustom,
                                 std::conditional_t<std::is_same_v<T, torques::During>, OwnDuring, T>>;

/// Lets Python's collector of garbage see the references() of an object, so that cycles through it are freed.
template <class T>
void show_references(PyHeapTypeObject* heap_type) {
  PyTypeObject& type = heap_type->ht_type;
  type.tp_flags |= Py_TPFLAGS_HAVE_GC;
  type.tp_traverse = [](PyObject* self, visitproc visit, void* arg) -> int {
    Py_VISIT(Py_TYPE(self));
    if (!py::detail::is_holder_constructed(self)) return 0;
    for (const py::object* reference : py::cast<T&>(py::handle(self)).references()) Py_VISIT(reference->ptr());
    return 0;
  };
  type.tp_clear = [](PyObject* self) -> int {
    if (!py::detail::is_holder_constructed(self)) return 0;
    for (py::object* reference : py::cast<T&>(py::handle(self)).references()) *reference = py::none();
    return 0;
  };
}

/// polhode.torques.Custom: a Python callable, or a compiled function pointer from numba, ctypes or C++.
void bind_torque_custom(py::module_& m);

/// polhode.torques.Formula, and the symbols of its traces.
void bind_torque_formula(py::module_& m);
void bind_formula_symbols(py::module_& m);

/// polhode.torques.During: another torque, within windows of time.
void bind_torque_during(py::module_& m);

/// What a torque looks at, as `torque.traits` shows it.
inline py::dict describe_traits(const TorqueTraits& traits) {
  py::dict dict;
  dict["uses_time"] = traits.uses_time;
  dict["uses_attitude"] = traits.uses_attitude;
  dict["uses_rates"] = traits.uses_rates;
  dict["has_potential"] = traits.has_potential;
  return dict;
}

template <class T>
void bind_traits(py::class_<T>& type) {
  type.def_property_readonly("traits", [](const T& torque) {
    return describe_traits(torque.traits());
  }, "dict: uses_time, uses_attitude, uses_rates, has_potential.");
}

/// The inertia, which may be left out for a torque that does not depend on it.
inline Matrix3d to_used_inertia(const AnyTorque& torque, py::handle inertia) {
  if (!inertia.is_none()) return to_inertia(inertia, "inertia").matrix();
  if (uses_inertia(torque)) throw InvalidInput("inertia", "given", "nothing", "the torque depends on it");
  return Matrix3d::Identity();
}

inline Array compute_value(const AnyTorque& torque, py::handle t, py::handle omega, py::handle attitude,
                           py::handle inertia, py::handle states) {
  const Matrix3d I_B = to_used_inertia(torque, inertia);
  const Vector3d w = to_vector3(omega, "omega");
  const Quat unit = to_attitude(attitude, "attitude");
  const double q[4] = {unit.x, unit.y, unit.z, unit.w};
  Vector3d tau = Vector3d::Zero();
  const TorqueInput in{to_real(t, "t"), w.data(), q, I_B};
  const bool in_windows = std::holds_alternative<torques::During>(torque);
  const torques::Formula* formula = in_windows ? nullptr : find_formula(torque);
  if (formula != nullptr && !formula->states().empty()) {
    const std::vector<double> outputs = formula->compute(in, to_state_numbers(formula->states(), states));
    return from_vector3(Vector3d(outputs[0], outputs[1], outputs[2]));
  }
  if (!states.is_none()) throw InvalidInput("states", "left out for a torque without states", std::string(py::repr(states)));
  std::visit([&](const auto& one) { one.add(in, tau.data()); }, torque);
  return from_vector3(tau);
}

/// One state in a docstring.
#define POLHODE_STATE_DOC                     \
  "Parameters\n----------\n"                  \
  "t : float\n    Time [s].\n"                \
  "omega : array_like, shape (3,)\n"          \
  "    Rates in body axes [rad/s].\n"         \
  "attitude : array_like, shape (4,)\n"       \
  "    Unit quaternion (x, y, z, w).\n"

constexpr const char* value_doc = "Return the torque at one state.\n\n" POLHODE_STATE_DOC R"doc(inertia : InertiaTensor or array_like, optional
    Of the body, for a torque that depends on it [kg m^2].
states : dict, optional
    Numbers of the torque's own states by name, each with the shape of its start; the starts if left out.

Returns
-------
ndarray, shape (3,)
    In body axes [N m].
)doc";

/// value(t, omega, attitude, inertia=None, states=None) of a torque's class.
template <class T, class... Options>
void bind_value(py::class_<T, Options...>& type) {
  type.def("value", [](const T& torque, const py::object& t, const py::object& omega, const py::object& attitude,
                       const py::object& inertia, const py::object& states) {
    if constexpr (requires { torque.get(); }) {
      return compute_value(torque.get(), t, omega, attitude, inertia, states);
    } else {
      return compute_value(torque, t, omega, attitude, inertia, states);
    }
  }, py::arg("t"), py::arg("omega"), py::arg("attitude"), py::arg("inertia") = py::none(),
           py::arg("states") = py::none(), value_doc);
}

}  // namespace polhode::python
