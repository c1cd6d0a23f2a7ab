#include <pybind11/stl.h>

#include "bind.hpp"
#include "bind_scene.hpp"
#include "convert.hpp"
#include "gil.hpp"
#include "polhode/core/error.hpp"
#include "polhode/derivative/sensitivity.hpp"

namespace polhode::python {
namespace {

TurnSide to_turn_side(const std::string& side) {
  if (side == "space") return TurnSide::space;
  if (side == "body") return TurnSide::body;
  throw InvalidInput("side", "'space' or 'body'", "'" + side + "'");
}

py::tuple sensitivity_of(const Scene& scene, const std::vector<std::string>& groups, double accuracy,
                         bool certify, const std::string& side, long max_steps) {
  const SensitivityOptions options{
      .accuracy = accuracy, .certify = certify, .side = to_turn_side(side), .max_steps = max_steps};
  MotionSensitivity found;
  {
    const WithoutGil nogil;
    found = compute_sensitivity(scene, groups, options);
  }
  const auto n = static_cast<py::ssize_t>(scene.times().size()), width = static_cast<py::ssize_t>(found.columns.size());
  return py::make_tuple(Array({n, py::ssize_t{3}}, found.omega.data()),
                        Array({n, py::ssize_t{4}}, found.attitude.data()),
                        Array({n, py::ssize_t{3}, width}, found.d_omega.data()),
                        Array({n, py::ssize_t{3}, width}, found.d_attitude.data()), found.columns,
                        certify ? py::object(Array(width, found.error.data())) : py::none(), found.steps, found.runs);
}

}  // namespace

void bind_solve_sensitivity(py::module_& m) {
  m.def("sensitivity", &sensitivity_of, py::arg("scene"), py::arg("groups"), py::arg("accuracy"), py::arg("certify"),
        py::arg("side"), py::arg("max_steps"),
        "omega, attitude, their derivatives, the names of the columns, their errors, the steps and the runs.");
}

}  // namespace polhode::python
