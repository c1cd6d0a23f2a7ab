#include "bind.hpp"

namespace polhode::python {

void bind_inertia(py::module_&) {}

}  // namespace polhode::python
