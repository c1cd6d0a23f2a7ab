#include "bind_solve_options.hpp"

#include <pybind11/stl.h>

#include <string_view>

#include "convert.hpp"
#include "gil.hpp"
#include "polhode/core/error.hpp"

namespace polhode::python {
namespace {

Formulation to_formulation(py::handle value) {
  const std::string name = py::str(value);
  if (name == "euler") return Formulation::euler;
  if (name == "lagrangian") return Formulation::lagrangian;
  throw InvalidInput("formulation", "'euler' or 'lagrangian'", "'" + name + "'");
}

/// From a polhode.Event. The closure holds a plain pointer, since it is copied without the GIL.
SceneEvent to_event(py::handle event) {
  return {[event](const State& state) {
            return with_gil([&] {
              const py::object function = event.attr("function"), omega = from_vector3(state.omega);
              const py::object attitude = from_quat(state.attitude);
              const py::object value = state.states.empty() ? function(state.t, omega, attitude)
                                                            : function(state.t, omega, attitude, state.states);
              return to_real(value, "the event's function");
            });
          },
          event.attr("direction").cast<int>(), event.attr("terminal").cast<bool>()};
}

std::vector<SceneEvent> to_events(py::handle list) {
  std::vector<SceneEvent> events;
  for (const py::handle event : list) events.push_back(to_event(event));
  return events;
}

/// True, False or "proof".
void read_certify(py::handle value, SolveOptions& to) {
  to.proof = py::isinstance<py::str>(value);
  if (to.proof && std::string(py::str(value)) != "proof")
    throw InvalidInput("certify", "True, False or 'proof'", std::string(py::repr(value)));
  to.certify = to.proof || value.cast<bool>();
}

/// One option: its name in Python, and how its value is read.
struct Option {
  std::string_view name;
  void (*read)(py::handle value, SolveOptions& options);
};

constexpr Option all_options[] = {
    {"accuracy", [](py::handle value, SolveOptions& to) { to.accuracy = to_real(value, "accuracy"); }},
    {"method", [](py::handle value, SolveOptions& to) { to.method = std::string(py::str(value)); }},
    {"certify", &read_certify},
    {"rtol", [](py::handle value, SolveOptions& to) { to.rtol = to_real(value, "rtol"); }},
    {"atol", [](py::handle value, SolveOptions& to) { to.atol = to_real(value, "atol"); }},
    {"step", [](py::handle value, SolveOptions& to) { to.step = to_real(value, "step"); }},
    {"max_steps", [](py::handle value, SolveOptions& to) { to.max_steps = value.cast<long>(); }},
    {"dense", [](py::handle value, SolveOptions& to) { to.dense = value.cast<bool>(); }},
    {"formulation", [](py::handle value, SolveOptions& to) { to.formulation = to_formulation(value); }},
    {"events", [](py::handle value, SolveOptions& to) { to.events = to_events(value); }},
    {"progress", [](py::handle value, SolveOptions& to) { to.progress = make_progress(value); }},
    {"body", [](py::handle value, SolveOptions& to) { to.body = value.cast<std::uint64_t>(); }},
    {"leave_out", [](py::handle value, SolveOptions& to) { to.leave_out = value.cast<bool>(); }},
    {"cost_factors",
     [](py::handle value, SolveOptions& to) { to.cost_factors = &value.cast<const Factors&>().by_name; }},
};

const Option& find_option(std::string_view name) {
  for (const Option& option : all_options)
    if (option.name == name) return option;
  throw InvalidInput("options", "names of options of solve", "'" + std::string(name) + "'");
}

std::string_view to_view(py::handle text) {
  Py_ssize_t size = 0;
  const char* bytes = PyUnicode_AsUTF8AndSize(text.ptr(), &size);
  if (bytes == nullptr) throw py::error_already_set();
  return {bytes, static_cast<std::size_t>(size)};
}

}  // namespace

SolveOptions to_solve_options(const py::dict& given) {
  SolveOptions options;
  for (const auto& [name, value] : given) {
    const Option& option = find_option(to_view(name));
    if (!value.is_none()) option.read(value, options);
  }
  return options;
}

Progress make_progress(py::handle callback) {
  return [callback](double reached, double last) {
    return with_gil([&] {
      check_signals();
      if (callback.is_none()) return true;
      const py::object answer = callback(reached, last);
      return answer.is_none() || static_cast<bool>(py::bool_(answer));
    });
  };
}

}  // namespace polhode::python
