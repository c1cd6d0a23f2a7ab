#pragma once

#include "bind.hpp"
#include "polhode/solve/plan.hpp"

namespace polhode::python {

void bind_solve_plan(py::module_& m);

/// A plan by field name, as the constructor of polhode.Plan reads it.
py::dict describe_plan(const Plan& plan, const std::string& state, double rtol);

}  // namespace polhode::python
