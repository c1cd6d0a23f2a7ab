#pragma once

#include <vector>

#include "bind.hpp"

namespace polhode::python {

/// Gives each class a `__reduce__` from its state. Python's own, which protocols 0 and 1 of pickle call, makes an
/// instance of pybind11's base class, and that ends the process.
void reduce_by_state(const std::vector<py::type>& classes);

}  // namespace polhode::python
