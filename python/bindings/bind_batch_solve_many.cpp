#include <pybind11/stl.h>

#include "bind_many.hpp"
#include "bind_solve_options.hpp"
#include "convert.hpp"
#include "gil.hpp"
#include "polhode/batch/solve_many.hpp"
#include "polhode/core/error.hpp"

namespace polhode::python {
namespace {

py::dict solve_batch(const ManyScenes& many, std::size_t bodies, std::size_t times, const py::object& omega_out,
                     const py::object& attitude_out, const py::dict& given, int threads, bool refuse,
                     const std::vector<std::uint64_t>& numbers) {
  const SolveOptions options = to_solve_options(given);
  const MakeScene make_scene = many.maker();
  const auto target = [](const py::object& array) {
    return array.is_none() ? nullptr : array.cast<py::array_t<double, py::array::c_style>>().mutable_data();
  };
  double *out_w = target(omega_out), *out_q = target(attitude_out);
  std::vector<ManyResult> results;
  {
    const WithoutGil nogil;
    results = solve_many(bodies, times, make_scene, options, out_w, out_q, threads, refuse, numbers);
  }
  py::list status, message, methods;
  const auto n = static_cast<py::ssize_t>(bodies);
  Array reached(n), errors(n);
  py::array_t<long> steps(n);
  py::array_t<bool> success(n), lanes(n), refused(n);
  for (py::ssize_t i = 0; i < n; ++i) {
    const ManyResult& result = results[static_cast<std::size_t>(i)];
    status.append(std::string(to_text(result.status)));
    message.append(result.message);
    methods.append(result.method);
    reached.mutable_data()[i] = result.t_reached;
    errors.mutable_data()[i] = result.error;
    steps.mutable_data()[i] = result.steps;
    success.mutable_data()[i] = result.success;
    lanes.mutable_data()[i] = result.lanes;
    refused.mutable_data()[i] = result.refused;
  }
  py::dict all;
  all["status"] = py::tuple(status);
  all["message"] = py::tuple(message);
  all["method"] = py::tuple(methods);
  all["t_reached"] = reached;
  all["error"] = errors;
  all["steps"] = steps;
  all["success"] = success;
  all["lanes"] = lanes;
  all["refused"] = refused;
  return all;
}

}  // namespace

void bind_batch_solve_many(py::module_& m) {
  m.def("_solve_many", &solve_batch, py::arg("many"), py::arg("bodies"), py::arg("times"), py::arg("omega_out"),
        py::arg("attitude_out"), py::arg("options"), py::arg("threads"), py::arg("refuse"),
        py::arg("numbers") = std::vector<std::uint64_t>());
}

}  // namespace polhode::python
