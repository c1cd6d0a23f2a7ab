#include "reduce.hpp"

#include <string>

namespace polhode::python {
namespace {

py::tuple reduce(const py::object& self) {
  const py::type cls = py::type::of(self);
  const py::type plain = py::reinterpret_borrow<py::type>(reinterpret_cast<PyObject*>(&PyBaseObject_Type));
  // Python 3.11 gave every object a __getstate__, which knows nothing of what C++ holds.
  const py::object own = py::getattr(cls, "__getstate__", py::none());
  if (own.is_none() || own.is(py::getattr(plain, "__getstate__", py::none())))
    throw py::type_error("cannot pickle '" + cls.attr("__name__").cast<std::string>() + "' object");
  return py::make_tuple(py::module_::import("copyreg").attr("__newobj__"), py::make_tuple(cls), own(self));
}

}  // namespace

void reduce_by_state(const std::vector<py::type>& classes) {
  for (const py::type& cls : classes) {
    cls.attr("__reduce__") = py::cpp_function(&reduce, py::name("__reduce__"), py::is_method(cls),
                                              "Return what pickle makes the object from.");
  }
}

}  // namespace polhode::python
