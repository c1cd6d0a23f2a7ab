#pragma once

#include <pybind11/typing.h>

#include <vector>

#include "convert.hpp"
#include "gil.hpp"
#include "polhode/core/state.hpp"

// What the closed forms share on their way to Python.
namespace polhode::python {

/// A new array of shape t.shape + (width,).
inline Array result_for(const Array& t, py::ssize_t width) {
  std::vector<py::ssize_t> shape(t.shape(), t.shape() + t.ndim());
  shape.push_back(width);
  return Array(shape);
}

/// omega and attitude of a closed form at one time, or at an array of them with the GIL released.
template <class Motion>
py::typing::Tuple<Array, Array> at(const Motion& motion, py::handle t) {
  if (PyFloat_CheckExact(t.ptr())) {
    const State state = motion.at(PyFloat_AS_DOUBLE(t.ptr()));
    return py::make_tuple(from_vector3(state.omega), from_quat(state.attitude));
  }
  const Array times = to_array(t, "t");
  Array omega = result_for(times, 3), attitude = result_for(times, 4);
  const double* in = times.data();
  double *w = omega.mutable_data(), *q = attitude.mutable_data();
  const auto n = static_cast<std::size_t>(times.size());
  {
    const WithoutGil nogil;
    motion.at(in, n, w, q);
  }
  return py::make_tuple(omega, attitude);
}

}  // namespace polhode::python
