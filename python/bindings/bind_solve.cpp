#include "bind.hpp"

namespace polhode::python {

void bind_solve(py::module_&) {}

}  // namespace polhode::python
