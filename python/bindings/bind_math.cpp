#include "bind.hpp"

namespace polhode::python {

void bind_math(py::module_&) {}

}  // namespace polhode::python
