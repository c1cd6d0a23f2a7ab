#pragma once

#include "bind.hpp"

namespace polhode::python {

/// Calls of the module's classes that fit no signature raise InvalidInput, with the signature and what does not fit.
/// pybind11's own TypeError would print all arguments, whole arrays too.
void refuse_wrong_calls(py::module_& m);

}  // namespace polhode::python
