#include "bind.hpp"

namespace polhode::python {

void bind_ode(py::module_&) {}

}  // namespace polhode::python
