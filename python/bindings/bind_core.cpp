#include <pybind11/stl.h>

#include "bind.hpp"
#include "polhode/core/build_info.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/version.hpp"

namespace polhode::python {

void bind_core(py::module_& m) {
  m.attr("__version__") = POLHODE_VERSION;
  m.def("build_info", &build_info, "How the installed binary was built.");
  py::register_exception<InvalidInput>(m, "InvalidInput", PyExc_ValueError);
  py::register_exception<IntegrationFailure>(m, "IntegrationFailure", PyExc_RuntimeError);
}

}  // namespace polhode::python
