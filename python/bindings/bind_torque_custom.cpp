#include "bind_torque.hpp"

#include <cstdint>
#include <cstring>
#include <memory>

#include "convert.hpp"
#include "gil.hpp"
#include "polhode/core/error.hpp"
#include "polhode/torque/custom.hpp"

namespace polhode::python {
namespace {

using torques::Custom;

/// Three floats in a tuple or list, or a float64 array of three: without the way through NumPy's general conversion.
bool read_plainly(py::handle result, double* torque) {
  if (PyTuple_CheckExact(result.ptr()) || PyList_CheckExact(result.ptr())) {
    if (PySequence_Fast_GET_SIZE(result.ptr()) != 3) return false;
    for (Py_ssize_t i = 0; i < 3; ++i) {
      PyObject* item = PySequence_Fast_GET_ITEM(result.ptr(), i);
      if (!PyFloat_CheckExact(item)) return false;
      torque[i] = PyFloat_AS_DOUBLE(item);
    }
    return true;
  }
  if (!py::isinstance<Array>(result)) return false;
  const auto tau = py::reinterpret_borrow<py::array>(result);
  if (tau.ndim() != 1 || tau.shape(0) != 3) return false;
  std::memcpy(torque, tau.data(), 3 * sizeof(double));   // at any address
  return true;
}

void call_with_gil(double t, const double* omega, const double* attitude, double* torque, OwnCustom& owner) {
  py::object w = owner.omega.take(omega), q = owner.attitude.take(attitude);
  const py::float_ time(t);
  PyObject* arguments[] = {nullptr, time.ptr(), w.ptr(), q.ptr()};
  const py::object result = py::reinterpret_steal<py::object>(
      PyObject_Vectorcall(owner.function.ptr(), arguments + 1, 3 | PY_VECTORCALL_ARGUMENTS_OFFSET, nullptr));
  if (!result) throw py::error_already_set();
  if (!read_plainly(result, torque)) {
    const Array tau = to_array(result, "the torque's function");
    if (tau.ndim() != 1 || tau.shape(0) != 3) {
      throw InvalidInput(
          "the torque's function", "one that returns three numbers",
          "shape " + std::string(py::str(result.attr("__class__"))) + " of size " + std::to_string(tau.size()));
    }
    std::copy_n(tau.data(), 3, torque);
  }
  owner.omega.give_back(std::move(w));
  owner.attitude.give_back(std::move(q));
}

void call_python(double t, const double* omega, const double* attitude, double* torque, void* data) {
  with_gil([&] { call_with_gil(t, omega, attitude, torque, *static_cast<OwnCustom*>(data)); });
}

double call_python_potential(double t, const double* attitude, void* data) {
  return with_gil([&] {
    const OwnCustom& owner = *static_cast<const OwnCustom*>(data);
    Array q(4);
    std::copy_n(attitude, 4, q.mutable_data());
    return to_real(owner.potential(t, q), "the torque's potential");
  });
}

/// The address of a compiled function: numba's cfunc has `.address`, ctypes' function types are cast; 0 for anything
/// else.
std::uintptr_t find_address(py::handle function) {
  if (py::isinstance<py::capsule>(function)) {
    const py::capsule capsule = py::reinterpret_borrow<py::capsule>(function);
    return reinterpret_cast<std::uintptr_t>(PyCapsule_GetPointer(capsule.ptr(), PyCapsule_GetName(capsule.ptr())));
  }
  if (py::hasattr(function, "address")) return function.attr("address").cast<std::uintptr_t>();
  const py::module_ ctypes = py::module_::import("ctypes");
  if (py::isinstance(function, ctypes.attr("_CFuncPtr"))) {
    const py::object value = ctypes.attr("cast")(function, ctypes.attr("c_void_p")).attr("value");
    return value.is_none() ? 0 : value.cast<std::uintptr_t>();
  }
  return 0;
}

bool is_compiled(py::handle function) {
  return py::isinstance<py::capsule>(function) || py::hasattr(function, "address") ||
         (py::hasattr(py::type::of(function), "_flags_") && py::hasattr(py::type::of(function), "_restype_"));
}

std::unique_ptr<OwnCustom> make_custom(const py::object& function, bool uses_time, bool uses_attitude, bool uses_rates,
                                       const py::object& potential, const py::object& data,
                                       const py::object& breaks) {
  const Array times = to_array(breaks, "Custom.breaks");
  if (times.ndim() != 1) {
    throw InvalidInput("Custom.breaks", "a list of times", std::to_string(times.ndim()) + " dimensions");
  }
  const std::vector<double> cuts(times.data(), times.data() + times.size());
  auto own = std::make_unique<OwnCustom>();
  own->function = function, own->potential = potential, own->data = data;
  own->claims = {uses_time, uses_attitude, uses_rates};
  if (is_compiled(function)) {
    const std::uintptr_t address = find_address(function);
    const std::uintptr_t user = data.is_none() ? 0 : data.cast<std::uintptr_t>();
    Custom::Potential compiled_potential = nullptr;
    if (!potential.is_none()) {
      if (!is_compiled(potential)) {
        throw InvalidInput("Custom.potential", "compiled if the function is", std::string(py::repr(potential)));
      }
      compiled_potential = reinterpret_cast<Custom::Potential>(find_address(potential));
    }
    own->torque.emplace(reinterpret_cast<Custom::Function>(address), reinterpret_cast<void*>(user), own->claims,
                        compiled_potential);
    own->torque = own->torque->with_breaks(cuts);
    return own;
  }
  if (!PyCallable_Check(function.ptr())) {
    throw InvalidInput("Custom.function", "callable as function(t, omega, attitude)",
                       std::string(py::str(py::type::of(function))));
  }
  if (!potential.is_none() && !PyCallable_Check(potential.ptr())) {
    throw InvalidInput("Custom.potential", "callable as potential(t, attitude)",
                       std::string(py::str(py::type::of(potential))));
  }
  if (!data.is_none()) {
    throw InvalidInput("Custom.data", "left out for a Python callable", std::string(py::repr(data)),
                       "only a compiled function receives the pointer");
  }
  own->torque.emplace(&call_python, own.get(), own->claims, potential.is_none() ? nullptr : &call_python_potential);
  own->torque = own->torque->with_breaks(cuts);
  return own;
}

py::tuple get_breaks(const OwnCustom& own) { return py::tuple(py::cast(own.get().breaks())); }

py::tuple get_custom_state(const OwnCustom& own) {
  return py::make_tuple(own.function, own.claims.uses_time, own.claims.uses_attitude, own.claims.uses_rates,
                        own.potential, own.data, get_breaks(own));
}

constexpr const char* custom_doc =
    R"doc(Custom(function, *, uses_time=True, uses_attitude=True, uses_rates=True, potential=None, data=None, breaks=())

A torque of your own.

Parameters
----------
function : callable or compiled function pointer
    A Python callable ``function(t, omega, attitude)`` that returns the torque in body axes, shape (3,) [N m]; omega is
    in body axes, shape (3,) [rad/s], attitude is the unit quaternion (x, y, z, w). Or a function with the C signature
    ``void (double t, const double *omega, const double *attitude, double *torque, void *data)`` as a numba ``cfunc``,
    a ctypes function or a capsule: it is called with no Python in the loop.
uses_time, uses_attitude, uses_rates : bool
    What the function looks at. A false claim makes answers wrong: claim only what is sure.
potential : callable, optional
    ``potential(t, attitude)`` [J], in the same form as the function
    (``double (double t, const double *attitude, void *data)``), when the torque is conservative: energy is then watched.
data : int, optional
    The address handed to a compiled function.
breaks : sequence of float
    Times at which the function may jump or kink [s]: the edges of a pulse, the knots of a table. `solve` divides the
    span there, so that no step crosses one. At the end of a part the function is called slightly before it.

Raises
------
InvalidInput
    For what cannot be called, or an answer that has another shape than (3,), or is not finite at the start; one that is
    not finite later ends the run there, with everything up to there. What the function raises comes through as it is.
)doc";

}  // namespace

py::object LentArray::take(const double* values) {
  py::object array = py::reinterpret_steal<py::object>(free_.exchange(nullptr));
  if (!array) array = Array(size_);
  std::copy_n(values, size_, static_cast<double*>(py::reinterpret_borrow<py::array>(array).mutable_data()));
  return array;
}

void bind_torque_custom(py::module_& m) {
  py::class_<OwnCustom> type(m, "Custom", custom_doc, py::custom_type_setup(&show_references<OwnCustom>));
  type.def(py::init(&make_custom), py::arg("function"), py::kw_only(), py::arg("uses_time") = true,
           py::arg("uses_attitude") = true, py::arg("uses_rates") = true, py::arg("potential") = py::none(),
           py::arg("data") = py::none(), py::arg("breaks") = py::tuple());
  type.def_property_readonly("function", [](const OwnCustom& own) { return own.function; });
  type.def_property_readonly("breaks", &get_breaks);
  type.def_property_readonly("traits", [](const OwnCustom& own) {
    return describe_traits(own.get().traits());
  });
  bind_value(type);
  type.def("__repr__", [](const OwnCustom& own) {
    return "polhode.torques.Custom(" + std::string(py::repr(own.function)) + ")";
  });
  type.def("__eq__", [](const OwnCustom& a, const py::object& b) {
    return py::isinstance<OwnCustom>(b) && get_custom_state(a).equal(get_custom_state(b.cast<const OwnCustom&>()));
  });
  type.def("__hash__", [](const OwnCustom& own) { return py::hash(own.function); });
  type.def(py::pickle(&get_custom_state, [](const py::tuple& state) {
    return from_state("Custom", state, 7, [](const py::tuple& s) {
      return make_custom(s[0], s[1].cast<bool>(), s[2].cast<bool>(), s[3].cast<bool>(), s[4], s[5], s[6]);
    });
  }));
}

}  // namespace polhode::python
