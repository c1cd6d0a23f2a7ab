#include "bind.hpp"

namespace polhode::python {

void bind_scene(py::module_&) {}

}  // namespace polhode::python
