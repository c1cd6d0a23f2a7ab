#include <pybind11/stl.h>

#include "bind_formula.hpp"
#include "polhode/core/error.hpp"

// The parts of a formula: texts, shared parts, parameters; as Python gives them, and in pickles.
namespace polhode::python {

std::string to_field(py::handle value, const std::string& where) {
  if (!py::isinstance<py::str>(value)) throw InvalidInput(where, "text", std::string(py::str(py::type::of(value))));
  if (PyUnicode_AsUTF8(value.ptr()) == nullptr) {
    PyErr_Clear();
    throw InvalidInput(where, "text that UTF-8 can write", std::string(py::str(py::repr(value))));
  }
  return value.cast<std::string>();
}

TextPairs to_let(py::handle let, const std::string& where) {
  TextPairs found;
  if (let.is_none()) return found;
  if (!py::isinstance<py::dict>(let))
    throw InvalidInput(where, "a dict of names and texts", std::string(py::str(py::type::of(let))));
  for (const auto& [name, text] : py::reinterpret_borrow<py::dict>(let))
    found.emplace_back(to_field(name, where), to_field(text, where));
  return found;
}

py::dict from_let(const TextPairs& let) {
  py::dict dict;
  for (const auto& [name, shared] : let) dict[py::str(name)] = shared;
  return dict;
}

py::tuple to_pairs(const std::vector<formula::Input>& inputs) {
  py::list pairs;
  for (const formula::Input& input : inputs) pairs.append(py::make_tuple(input.name, py::tuple(py::cast(input.values))));
  return py::tuple(pairs);
}

std::vector<formula::Input> from_pairs(const py::sequence& pairs) {
  std::vector<formula::Input> inputs;
  for (const py::handle one : pairs) {
    const py::sequence pair = one.cast<py::sequence>();
    formula::Input input{pair[0].cast<std::string>(), {}};
    for (const py::handle value : pair[1].cast<py::sequence>()) input.values.push_back(value.cast<double>());
    inputs.push_back(std::move(input));
  }
  return inputs;
}

py::tuple to_text_pairs(const TextPairs& let) {
  py::list pairs;
  for (const auto& [name, shared] : let) pairs.append(py::make_tuple(name, shared));
  return py::tuple(pairs);
}

TextPairs from_text_pairs(const py::sequence& pairs) {
  TextPairs let;
  for (const py::handle one : pairs) {
    const py::sequence pair = one.cast<py::sequence>();
    let.emplace_back(pair[0].cast<std::string>(), pair[1].cast<std::string>());
  }
  return let;
}

}  // namespace polhode::python
