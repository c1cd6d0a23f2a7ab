#pragma once

#include <vector>

#include "bind.hpp"

namespace polhode::python {

/// Objects of these classes that were never initialised (`Scene.__new__(Scene)`, or one whose constructor
/// raised, as a debugger shows it) say so. pybind11 would hand unset memory to their methods.
/// @param error  the exception that they raise, kept alive by the module
void guard_uninitialised(const std::vector<py::type>& classes, py::handle error);

}  // namespace polhode::python
