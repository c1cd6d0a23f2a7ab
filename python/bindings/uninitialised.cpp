#include "uninitialised.hpp"

#include <string_view>

#include "polhode/core/error.hpp"

namespace polhode::python {
namespace {

PyObject* invalid_input = nullptr;

// What the slots of every class held before. CPython has one function a slot for all that is defined by a method.
reprfunc plain_repr = nullptr, plain_str = nullptr;
hashfunc plain_hash = nullptr;
richcmpfunc plain_compare = nullptr;
lenfunc plain_length = nullptr;

bool is_initialised(PyObject* self) {
  const auto* const instance = reinterpret_cast<const py::detail::instance*>(self);
  const auto* const values =
      instance->simple_layout ? instance->simple_value_holder : instance->nonsimple.values_and_holders;
  return values != nullptr && values[0] != nullptr;
}

bool refuse(PyObject* self) {
  if (is_initialised(self)) return false;
  PyErr_Format(invalid_input, "%s: must be initialised, its constructor has not run or has failed",
               Py_TYPE(self)->tp_name);
  return true;
}

PyObject* say_so(PyObject* self) { return PyUnicode_FromFormat("<%s, not initialised>", Py_TYPE(self)->tp_name); }

PyObject* guard_repr(PyObject* self) { return is_initialised(self) ? plain_repr(self) : say_so(self); }
PyObject* guard_str(PyObject* self) { return is_initialised(self) ? plain_str(self) : say_so(self); }
Py_hash_t guard_hash(PyObject* self) { return refuse(self) ? -1 : plain_hash(self); }
Py_ssize_t guard_length(PyObject* self) { return refuse(self) ? -1 : plain_length(self); }
PyObject* guard_compare(PyObject* self, PyObject* other, int op) {
  return refuse(self) ? nullptr : plain_compare(self, other, op);
}

PyObject* guard_attribute(PyObject* self, PyObject* name) {
  if (!is_initialised(self)) {
    const char* const text = PyUnicode_AsUTF8(name);
    if (text == nullptr) return nullptr;
    // What initialises, and what the interpreter and debuggers ask of any object.
    bool harmless = false;
    for (const std::string_view known : {"__init__", "__setstate__", "__class__", "__dict__", "__doc__"}) {
      harmless = harmless || known == text;
    }
    if (!harmless && refuse(self)) return nullptr;
  }
  return PyObject_GenericGetAttr(self, name);
}

template <class Function>
void guard(Function& slot, Function& plain, Function guarded, Function of_object) {
  if (slot == nullptr || slot == of_object || (plain != nullptr && slot != plain)) return;
  plain = slot;
  slot = guarded;
}

/// In the place of the memory that pybind11 would hand to functions that get such an object.
void* refuse_memory(std::size_t) {
  throw InvalidInput("argument", "initialised", "an object whose constructor has not run or has failed");
}

void guard_class(PyTypeObject* type) {
  py::detail::get_type_info(type)->operator_new = refuse_memory;
  guard(type->tp_repr, plain_repr, guard_repr, PyBaseObject_Type.tp_repr);
  guard(type->tp_str, plain_str, guard_str, PyBaseObject_Type.tp_str);
  guard(type->tp_hash, plain_hash, guard_hash, PyBaseObject_Type.tp_hash);
  guard(type->tp_richcompare, plain_compare, guard_compare, PyBaseObject_Type.tp_richcompare);
  if (type->tp_as_sequence != nullptr) {
    guard(type->tp_as_sequence->sq_length, plain_length, guard_length, lenfunc{});
  }
  if (type->tp_getattro == PyObject_GenericGetAttr) {
    // As a wrapper in the class's dictionary, subclasses inherit the slot.
    const py::object plain = py::handle(reinterpret_cast<PyObject*>(&PyBaseObject_Type)).attr("__getattribute__");
    auto* const descriptor = reinterpret_cast<PyWrapperDescrObject*>(plain.ptr());
    PyObject* const wrapper =
        PyDescr_NewWrapper(type, descriptor->d_base, reinterpret_cast<void*>(guard_attribute));
    py::handle(reinterpret_cast<PyObject*>(type)).attr("__getattribute__") =
        py::reinterpret_steal<py::object>(wrapper);
  }
}

}  // namespace

void guard_uninitialised(const std::vector<py::type>& classes, py::handle error) {
  invalid_input = error.ptr();
  for (const py::type& cls : classes) guard_class(reinterpret_cast<PyTypeObject*>(cls.ptr()));
}

}  // namespace polhode::python
