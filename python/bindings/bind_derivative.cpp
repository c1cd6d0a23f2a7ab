#include <pybind11/stl.h>

#include "bind.hpp"
#include "bind_scene.hpp"
#include "convert.hpp"
#include "gil.hpp"
#include "polhode/core/error.hpp"
#include "polhode/derivative/sensitivity.hpp"
#include "polhode/scene/parameter.hpp"

namespace polhode::python {
namespace {

TurnSide to_turn_side(const std::string& side) {
  if (side == "space") return TurnSide::space;
  if (side == "body") return TurnSide::body;
  throw InvalidInput("side", "'space' or 'body'", "'" + side + "'");
}

/// A motion, its derivatives by column, the names and errors of the columns, and the cost.
struct FoundSensitivity {
  Array omega, attitude, d_omega, d_attitude, d_states;
  std::vector<std::string> columns;
  py::object error;   // None without a certificate
  long steps;
  int runs;
};

FoundSensitivity sensitivity_of(const Scene& scene, const std::vector<std::string>& groups, double accuracy,
                         bool certify, const std::string& side, long max_steps) {
  const SensitivityOptions options{
      .accuracy = accuracy, .certify = certify, .side = to_turn_side(side), .max_steps = max_steps};
  MotionSensitivity found;
  {
    const WithoutGil nogil;
    found = compute_sensitivity(scene, groups, options);
  }
  const auto n = static_cast<py::ssize_t>(scene.times().size()), width = static_cast<py::ssize_t>(found.columns.size());
  return {.omega = Array({n, py::ssize_t{3}}, found.omega.data()),
          .attitude = Array({n, py::ssize_t{4}}, found.attitude.data()),
          .d_omega = Array({n, py::ssize_t{3}, width}, found.d_omega.data()),
          .d_attitude = Array({n, py::ssize_t{3}, width}, found.d_attitude.data()),
          .d_states = Array({n, static_cast<py::ssize_t>(scene.count_states()), width}, found.d_states.data()),
          .columns = found.columns,
          .error = certify ? py::object(Array(width, found.error.data())) : py::none(),
          .steps = found.steps,
          .runs = found.runs};
}

}  // namespace

void bind_solve_sensitivity(py::module_& m) {
  py::class_<FoundSensitivity>(m, "_FoundSensitivity", "What `sensitivity` found.")
      .def_readonly("omega", &FoundSensitivity::omega)
      .def_readonly("attitude", &FoundSensitivity::attitude)
      .def_readonly("d_omega", &FoundSensitivity::d_omega)
      .def_readonly("d_attitude", &FoundSensitivity::d_attitude)
      .def_readonly("d_states", &FoundSensitivity::d_states)
      .def_readonly("columns", &FoundSensitivity::columns)
      .def_readonly("error", &FoundSensitivity::error)
      .def_readonly("steps", &FoundSensitivity::steps)
      .def_readonly("runs", &FoundSensitivity::runs);
  m.def("_parameter_names", [](const Scene& scene, const std::string& group) {
    std::vector<std::string> names;
    for (const SceneParameter& parameter : find_parameters(scene, group)) names.push_back(parameter.column);
    return names;
  }, py::arg("scene"), py::arg("group"));
  m.def("sensitivity", &sensitivity_of, py::arg("scene"), py::arg("groups"), py::arg("accuracy"), py::arg("certify"),
        py::arg("side"), py::arg("max_steps"),
        "The motion of a scene and its derivatives.");
}

}  // namespace polhode::python
