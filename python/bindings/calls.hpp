#pragma once

#include <vector>

#include "bind.hpp"

namespace polhode::python {

/// Calls of these classes that fit no signature raise InvalidInput, with the signature and what does not fit.
/// pybind11's own TypeError would print all arguments, whole arrays too.
void refuse_wrong_calls(const std::vector<py::type>& classes);

}  // namespace polhode::python
