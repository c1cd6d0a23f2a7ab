#include <pybind11/stl.h>

#include "convert.hpp"
#include "polhode/core/build_info.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/float_state.hpp"
#include "polhode/core/version.hpp"

namespace polhode::python {

void bind_core(py::module_& m) {
  m.attr("__version__") = POLHODE_VERSION;
  m.def("build_info", &build_info, "How the installed binary was built.");
  m.def("_first_home",
        [](const std::string& home) {
          static const std::string first = home;
          return first;
        },
        py::arg("home"), "The place of the package that called this first in the process.");
  m.def("flushes_to_zero", &flushes_to_zero, "Whether this thread takes numbers below 2.2e-308 for 0.");
  m.def("require_kept",
        [](const Array& array, const std::string& name) {
          for (py::ssize_t i = 0; i < array.size(); ++i) require_kept(array.data()[i], name);
        },
        py::arg("array"), py::arg("name"), "Raises InvalidInput for a number that this thread takes for 0.");
  py::register_exception<InvalidInput>(m, "InvalidInput", PyExc_ValueError);
  // A text that has no UTF-8, or an object of another kind, where C++ converts it itself.
  py::register_local_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(thrown);
    } catch (const py::cast_error&) {
      py::set_error(py::module_::import("polhode._core").attr("InvalidInput"),
                    "arguments: must be of the types in the documentation, and texts such that UTF-8 can write them");
    }
  });
  py::register_exception<IntegrationFailure>(m, "IntegrationFailure", PyExc_RuntimeError);
}

}  // namespace polhode::python
