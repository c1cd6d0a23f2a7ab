#pragma once

#include <array>
#include <atomic>
#include <optional>
#include <type_traits>

#include "bind.hpp"
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

}  // namespace polhode::python
