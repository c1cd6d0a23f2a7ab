#pragma once

#include <string>

#include "bind.hpp"
#include "polhode/clock/controller.hpp"

namespace polhode::python {

/// The controller of a Python object.
Controller to_controller(py::handle value, const std::string& name);

}  // namespace polhode::python
