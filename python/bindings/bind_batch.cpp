#include "bind.hpp"

namespace polhode::python {

void bind_batch(py::module_&) {}

}  // namespace polhode::python
