#include "bind.hpp"

namespace polhode::python {

void bind_exact(py::module_&) {}

}  // namespace polhode::python
