#pragma once

#include <string>
#include <utility>
#include <vector>

#include "bind.hpp"
#include "polhode/formula/program.hpp"

namespace polhode::python {

/// Parameters, or states, by their names: a number, or several.
std::vector<formula::Input> to_inputs(const py::dict& parameters, const std::string& prefix = "Formula.");
py::dict from_inputs(const std::vector<formula::Input>& inputs);
/// The same as tuples of pairs, for pickles.
py::tuple to_pairs(const std::vector<formula::Input>& inputs);
std::vector<formula::Input> from_pairs(const py::sequence& pairs);

/// One text of a formula.
std::string to_field(py::handle value, const std::string& where);

/// Names of shared parts, in order.
using TextPairs = std::vector<std::pair<std::string, std::string>>;
TextPairs to_let(py::handle let, const std::string& where);
py::dict from_let(const TextPairs& let);
py::tuple to_text_pairs(const TextPairs& let);
TextPairs from_text_pairs(const py::sequence& pairs);

/// polhode.MagneticField.
void bind_torque_field(py::module_& m);

}  // namespace polhode::python
