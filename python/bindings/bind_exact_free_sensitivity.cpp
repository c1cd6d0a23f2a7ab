#include "bind_batch.hpp"
#include "bind_exact.hpp"
#include "polhode/batch/free_sensitivity.hpp"
#include "polhode/core/error.hpp"
#include "polhode/exact/free_sensitivity.hpp"

namespace polhode::python {
namespace {

constexpr std::pair<const char*, SensitivityTo> names[] = {{"omega", SensitivityTo::omega},
                                                           {"attitude", SensitivityTo::attitude},
                                                           {"inertia", SensitivityTo::inertia},
                                                           {"axes", SensitivityTo::axes},
                                                           {"time", SensitivityTo::time}};

std::vector<SensitivityTo> to_wrt(py::handle given) {
  const py::tuple wanted = py::module_::import("polhode._sensitivity.sensitivity").attr("to_names")(given);
  std::vector<SensitivityTo> wrt;
  for (const py::handle item : wanted) {
    const std::string text = py::str(item).cast<std::string>();
    const auto* found =
        std::find_if(std::begin(names), std::end(names), [&](const auto& name) { return text == name.first; });
    if (found == std::end(names)) {
      throw InvalidInput("wrt", "among 'omega', 'attitude', 'inertia', 'axes' and 'time'", "'" + text + "'");
    }
    wrt.push_back(found->second);
  }
  return wrt;
}

RotationSide to_side(const std::string& side) {
  if (side == "space") return RotationSide::space;
  if (side == "body") return RotationSide::body;
  throw InvalidInput("side", "'space' or 'body'", "'" + side + "'");
}

Array columns_for(const Array& t, std::size_t width) {
  std::vector<py::ssize_t> shape(t.shape(), t.shape() + t.ndim());
  shape.push_back(3), shape.push_back(static_cast<py::ssize_t>(width));
  return Array(shape);
}

py::object sensitivity(const FreeMotion& motion, py::handle t, py::handle wrt, const std::string& side) {
  const Array times = to_array(t, "t");
  const FreeSensitivity found(motion, to_wrt(wrt), to_side(side));
  Array omega = result_for(times, 3), attitude = result_for(times, 4);
  Array d_omega = columns_for(times, found.columns()), d_attitude = columns_for(times, found.columns());
  const double* in = times.data();
  double *w = omega.mutable_data(), *q = attitude.mutable_data();
  double *d_w = d_omega.mutable_data(), *d_q = d_attitude.mutable_data();
  const auto n = static_cast<std::size_t>(times.size());
  {
    const WithoutGil nogil;
    found.at(in, n, w, q, d_w, d_q);
  }
  return py::module_::import("polhode._sensitivity.sensitivity")
      .attr("of_groups")(omega, attitude, d_omega, d_attitude, wrt, side);
}

std::size_t batch_free_sensitivity(const py::object& inertia, const Array& omega, const Array& attitude, const Array& t,
                                   py::handle wrt, const std::string& side, py::array_t<double, py::array::c_style> w,
                                   py::array_t<double, py::array::c_style> q,
                                   py::array_t<double, py::array::c_style> d_w,
                                   py::array_t<double, py::array::c_style> d_q, int threads) {
  Array moments;
  const auto batch = make_batch<FreeMotionBatch>(inertia, moments, omega, attitude, t);
  const std::vector<SensitivityTo> to = to_wrt(wrt);
  const RotationSide which = to_side(side);
  double *a = w.mutable_data(), *b = q.mutable_data(), *c = d_w.mutable_data(), *d = d_q.mutable_data();
  const WithoutGil nogil;
  return free_sensitivity(batch, to, which, a, b, c, d, threads);
}

}  // namespace

void bind_exact_free_sensitivity(py::module_& m) {
  auto cls = py::reinterpret_borrow<py::class_<FreeMotion>>(m.attr("FreeMotion"));
  cls.def("sensitivity", &sensitivity, py::arg("t"), py::arg("wrt") = py::make_tuple("omega", "inertia"),
          py::arg("side") = "space", R"(The motion and its derivatives at the given times.

Parameters
----------
t : array_like, any shape
    Times [s], as for :meth:`at`.
wrt : str or sequence of str
    What to differentiate with respect to, in the order of the columns: 'omega' (omega at t = 0), 'inertia' (the
    principal moments at fixed omega; ascending for a full tensor), 'attitude' (a small rotation at t = 0), 'axes' (a
    small rotation of the principal axes in the body), each three columns, and 'time', one.
side : {'space', 'body'}
    Small rotations of the attitude R: exp(d theta) R in space axes, or R exp(d theta) in body axes.

Returns
-------
Sensitivity
    `omega`, `attitude`, `d_omega` and `d_attitude` of shape (..., 3, n), `columns`, `transition`.

Raises
------
InvalidInput
    An unknown name, a name twice, or abs(omega t) > 1e25 rad.

Notes
-----
The error of a column is a few units of rounding of its size, in every regime. See docs/sensitivity.md.)");
  m.def("_free_sensitivity", &batch_free_sensitivity);
}

}  // namespace polhode::python
