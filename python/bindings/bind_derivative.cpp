#include <pybind11/stl.h>

#include <algorithm>
#include <limits>

#include "bind.hpp"
#include "bind_many.hpp"
#include "bind_scene.hpp"
#include "convert.hpp"
#include "gil.hpp"
#include "polhode/batch/sensitivity_many.hpp"
#include "polhode/core/error.hpp"
#include "polhode/derivative/sensitivity.hpp"
#include "polhode/scene/parameter.hpp"

namespace polhode::python {
namespace {

RotationSide to_rotation_side(const std::string& side) {
  if (side == "space") return RotationSide::space;
  if (side == "body") return RotationSide::body;
  throw InvalidInput("side", "'space' or 'body'", "'" + side + "'");
}

/// A motion, its derivatives by column, the names and errors of the columns, and the cost.
struct FoundSensitivity {
  Array omega, attitude, d_omega, d_attitude, d_states;
  std::vector<std::string> columns;
  py::object error;   // None without a certificate
  std::vector<int> scale;
  std::string uncertain;
  long steps;
  int runs;
};

FoundSensitivity sensitivity_of(const Scene& scene, const std::vector<std::string>& groups, double accuracy,
                                bool certify, const std::string& side, long max_steps, bool rescale, std::uint64_t body) {
  const SensitivityOptions options{.accuracy = accuracy, .certify = certify, .side = to_rotation_side(side),
                                   .max_steps = max_steps, .body = body, .rescale = rescale};
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
          .error = found.error.empty() ? py::none() : py::object(Array(width, found.error.data())),
          .scale = found.scale,
          .uncertain = found.uncertain,
          .steps = found.steps,
          .runs = found.runs};
}

/// Of many bodies, in the rows of arrays of (bodies, ...); rows of a failed body are NaN.
py::dict sensitivities_of(const ManyScenes& many, std::size_t bodies, std::size_t times,
                          const std::vector<std::string>& groups, double accuracy, bool certify,
                          const std::string& side, long max_steps, int threads, bool refuse,
                          const std::vector<std::uint64_t>& numbers) {
  const SensitivityOptions options{
      .accuracy = accuracy, .certify = certify, .side = to_rotation_side(side), .max_steps = max_steps};
  const MakeScene make_scene = many.maker();
  std::vector<ManySensitivity> all;
  {
    const WithoutGil nogil;
    all = compute_sensitivities(bodies, make_scene, groups, options, threads, refuse, numbers);
  }
  std::vector<std::string> columns;
  std::size_t states = 0;
  for (const ManySensitivity& one : all) {
    if (!one.failure.empty()) continue;
    const std::size_t rows = one.found.columns.size() * times;
    if (columns.empty()) columns = one.found.columns, states = rows > 0 ? one.found.d_states.size() / rows : 0;
    if (one.found.columns != columns || one.found.d_states.size() != states * rows)
      throw InvalidInput("sensitivity", "of the same numbers in all scenes", "other ones in some");
  }
  const auto make = [&](std::vector<std::size_t> shape) {
    std::vector<py::ssize_t> whole{static_cast<py::ssize_t>(bodies)};
    for (const std::size_t width : shape) whole.push_back(static_cast<py::ssize_t>(width));
    return Array(whole);
  };
  const std::size_t width = columns.size();
  Array w = make({times, 3}), q = make({times, 4}), d_w = make({times, 3, width}), d_q = make({times, 3, width});
  Array d_s = make({times, states, width}), error = make({width});
  py::list failures;
  for (std::size_t body = 0; body < bodies; ++body) {
    const MotionSensitivity& found = all[body].found;
    const auto store = [&](const std::vector<double>& from, Array& to) {
      const std::size_t rows = static_cast<std::size_t>(to.size()) / bodies;
      double* row = to.mutable_data() + body * rows;
      if (from.size() == rows) std::copy(from.begin(), from.end(), row);
      else std::fill_n(row, rows, std::numeric_limits<double>::quiet_NaN());
    };
    store(found.omega, w), store(found.attitude, q), store(found.d_omega, d_w), store(found.d_attitude, d_q);
    store(found.d_states, d_s), store(found.error, error);
    failures.append(all[body].failure);
  }
  py::dict result;
  result["omega"] = w, result["attitude"] = q, result["d_omega"] = d_w, result["d_attitude"] = d_q;
  result["d_states"] = d_s, result["columns"] = columns;
  const bool closed = std::all_of(all.begin(), all.end(), [](const ManySensitivity& one) {
    return one.failure.empty() && one.found.error.empty();
  });
  result["error"] = closed ? py::object(py::none()) : py::object(error);
  result["failures"] = py::tuple(failures);
  return result;
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
      .def_readonly("scale", &FoundSensitivity::scale)
      .def_readonly("uncertain", &FoundSensitivity::uncertain)
      .def_readonly("steps", &FoundSensitivity::steps)
      .def_readonly("runs", &FoundSensitivity::runs);
  m.def("_parameter_names", [](const Scene& scene, const std::string& group) {
    std::vector<std::string> names;
    for (const SceneParameter& parameter : find_parameters(scene, group)) names.push_back(parameter.column);
    return names;
  }, py::arg("scene"), py::arg("group"));
  m.def("sensitivity", &sensitivity_of, py::arg("scene"), py::arg("groups"), py::arg("accuracy"), py::arg("certify"),
        py::arg("side"), py::arg("max_steps"), py::arg("rescale") = false, py::arg("body") = 0,
        "The motion of a scene and its derivatives.");
  // Arrays of starts may be None, as those of the scene.
  py::class_<ManyScenes>(m, "_ManyScenes", "The scenes of many bodies.")
      .def(py::init<const py::list&, const py::object&, const py::object&, const py::object&, const py::object&,
                    const py::object&>(),
           py::arg("scenes"), py::arg("moments"), py::arg("omega"), py::arg("attitude"), py::arg("t0"),
           py::arg("times"), py::keep_alive<1, 2>());
  m.def("_sensitivities", &sensitivities_of, py::arg("many"), py::arg("bodies"), py::arg("times"), py::arg("groups"),
        py::arg("accuracy"), py::arg("certify"), py::arg("side"), py::arg("max_steps"), py::arg("threads"),
        py::arg("refuse"), py::arg("numbers") = std::vector<std::uint64_t>());
}

}  // namespace polhode::python
