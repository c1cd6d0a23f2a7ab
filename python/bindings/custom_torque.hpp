#pragma once

#include "bind.hpp"

namespace polhode::python {

/// polhode.torques.Custom: a Python callable, or a compiled function pointer from numba, ctypes or C++.
void bind_custom_torque(py::module_& m);

}  // namespace polhode::python
