#pragma once

#include <string>
#include <vector>

#include "bind.hpp"
#include "polhode/formula/program.hpp"

namespace polhode::python {

/// Parameters, or states, by their names: a number, or several.
std::vector<formula::Input> to_inputs(const py::dict& parameters, const std::string& prefix = "Formula.");
py::dict from_inputs(const std::vector<formula::Input>& inputs);

/// polhode.MagneticField.
void bind_torque_field(py::module_& m);

}  // namespace polhode::python
