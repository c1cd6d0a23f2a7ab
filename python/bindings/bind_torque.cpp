#include "bind.hpp"

namespace polhode::python {

void bind_torque(py::module_&) {}

}  // namespace polhode::python
