#include "bind.hpp"

namespace polhode::python {

void bind_attitude(py::module_&) {}

}  // namespace polhode::python
