#pragma once

#include "bind.hpp"
#include "polhode/solve/solve.hpp"

namespace polhode::python {

/// CostFactors as a Python class; pybind11 would turn a map into a dict.
struct Factors {
  CostFactors by_name;
};

/// Reads the options of a solve by name; None stands for the default. The dict must outlive the options, which refer to
/// its cost factors, events and callback. Throws InvalidInput for a name that is no option.
SolveOptions to_solve_options(const py::dict& given);

/// Ends a long run after Ctrl-C, or when the callback (which may be None) returns False. The run calls it without the
/// GIL. The callback must outlive it.
Progress make_progress(py::handle callback);

}  // namespace polhode::python
