#include <pybind11/stl.h>

#include "bind_clock.hpp"
#include "bind_formula.hpp"
#include "convert.hpp"
#include "gil.hpp"
#include "polhode/core/error.hpp"

// polhode.Controller; its Python class makes the texts of its law (python/polhode/_clock).
namespace polhode::python {
namespace {

std::vector<double> to_numbers(py::handle value, const char* name) {
  const Array array = to_array(value, name);
  require_finite(array, name);
  if (array.ndim() > 1) throw InvalidInput(name, "a number, or a list of numbers", "shape " + std::string(py::str(array.attr("shape"))));
  return {array.data(), array.data() + array.size()};
}

std::uint64_t to_seed(py::handle value) {
  try {
    return value.cast<std::uint64_t>();
  } catch (const py::cast_error&) {
    throw InvalidInput("Measure.seed", "a whole number from 0 to 2^64 - 1", std::string(py::repr(value)));
  }
}

Measure to_measure(py::handle value) {
  Measure measure;
  const auto get = [&](const char* name) { return to_real(value.attr(name), (std::string("Measure.") + name).c_str()); };
  measure.omega_noise = get("omega_noise"), measure.attitude_noise = get("attitude_noise");
  measure.field_noise = get("field_noise"), measure.omega_quantum = get("omega_quantum");
  measure.seed = to_seed(value.attr("seed"));
  measure.check();
  return measure;
}

/// A Python function of (t, numbers) that returns the numbers of the command and of the states. It keeps the function.
ControllerParts::Function to_function(const py::object& function, std::size_t inputs, std::size_t commands, std::size_t states) {
  const auto kept = std::shared_ptr<py::object>(new py::object(function), [](py::object* one) {
    with_gil([&] { delete one; });
  });
  return [kept, inputs, commands, states](double t, const double* in, double* out) {
    with_gil([&] {
      const Array given(static_cast<py::ssize_t>(7 + inputs), in);
      const Array found = (*kept)(t, given).cast<Array>();
      std::copy_n(in + 7, inputs, out);
      std::copy_n(found.data(), commands, out);
      std::copy_n(found.data() + commands, states, out + inputs - states);
    });
  };
}

Controller make_controller(const py::dict& given) {
  ControllerParts parts;
  parts.period = to_real(given["period"], "Controller.period");
  parts.output = to_output(to_field(given["output"], "Controller.output"));
  parts.delay = to_real(given["delay"], "Controller.delay");
  if (!given["width"].is_none()) parts.width = to_real(given["width"], "Controller.width");
  parts.start = to_real(given["start"], "Controller.start");
  if (!given["limit"].is_none()) parts.limit = to_numbers(given["limit"], "Controller.limit");
  if (!given["field"].is_none()) parts.field = given["field"].attr("_core").cast<const MagneticField&>();
  parts.rotors = given["rotors"].cast<int>();
  parts.measure = to_measure(given["measure"]);
  parts.law.initial = to_numbers(given["initial"], "Controller.initial");
  parts.law.states = to_inputs(given["states"], "Controller.states.");
  parts.law.parameters = to_inputs(given["parameters"], "Controller.parameters.");
  std::size_t states = 0;
  for (const formula::Input& state : parts.law.states) states += state.values.size();
  if (!given["function"].is_none()) {
    const std::size_t commands = parts.law.initial.size();
    const std::size_t inputs = commands + (parts.field ? 3 : 0) + static_cast<std::size_t>(parts.rotors) + states;
    parts.function = to_function(given["function"], inputs, commands, states);
    return Controller(std::move(parts));
  }
  parts.law.command = to_field(given["command"], "Controller.command");
  if (!given["let"].is_none()) parts.law.let = to_let(given["let"], "Controller.let");
  const py::dict update = given["update"];
  for (const formula::Input& state : parts.law.states) {
    const std::string where = "Controller.update." + state.name;
    if (!update.contains(state.name)) throw InvalidInput(where, "given for each state", "none");
    parts.law.updates.push_back(to_field(update[py::str(state.name)], where));
  }
  for (const auto& [key, text] : update)
    if (formula::find_place(parts.law.states, std::string(py::str(key))).count == 0)
      throw InvalidInput("Controller.update", "of states that are given", std::string(py::str(key)));
  return Controller(std::move(parts));
}

}  // namespace

void bind_clock(py::module_& m) {
  py::class_<Controller>(m, "Controller")
      .def(py::init(&make_controller), py::arg("parts"))
      .def("_call", [](const Controller& controller, double t, const Array& in) {
        formula::Program program = controller.program();
        Array out(static_cast<py::ssize_t>(program.outputs.size()));
        formula::Evaluator evaluator(program);
        evaluator(t, in.data(), nullptr, out.mutable_data());
        return out;
      });
}

Controller to_controller(py::handle value, const std::string& name) {
  if (!py::isinstance<Controller>(value))
    throw InvalidInput(name, "a polhode.Controller", std::string(py::str(py::type::of(value))));
  return value.cast<const Controller&>();
}

}  // namespace polhode::python
