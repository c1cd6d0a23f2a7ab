#pragma once

#include <optional>

#include "bind.hpp"
#include "polhode/solve/plan.hpp"

namespace polhode::python {

void bind_plan(py::module_& m);

/// None, or one finite number.
std::optional<double> to_optional(const py::object& value, const char* name);

/// A class of its own, or it would be taken for a dict.
struct Factors {
  CostFactors by_name;
};

/// A plan's parts, in the order of the constructor of polhode.Plan.
py::tuple describe_plan(const Plan& plan, const std::string& state, double rtol);

/// What a plan is made of, from Python.
SolveOptions to_wishes(const py::object& accuracy, const py::object& method, bool certify,
                       const std::string& formulation);

}  // namespace polhode::python
