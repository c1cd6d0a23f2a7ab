#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "bind_batch.hpp"
#include "bind_exact.hpp"
#include "convert.hpp"
#include "gil.hpp"
#include "polhode/batch/free_motion.hpp"
#include "polhode/batch/gyrostat.hpp"
#include "polhode/batch/heavy_top.hpp"
#include "polhode/core/error.hpp"
#include "polhode/core/float_state.hpp"
#include "progress.hpp"

namespace polhode::python {
namespace {

/// The rows of an output array; the size is that of the result.
template <class S>
S* rows_of(py::handle out, std::size_t size) {
  auto array = py::cast<py::array_t<S, py::array::c_style>>(out);
  if (static_cast<std::size_t>(array.size()) != size) throw InvalidInput("out", "of the result's size", "another");
  return array.mutable_data();
}

/// What Python asks for: arrays by name, all of doubles or all of floats, written in place. `vectors` (bodies, 3) are
/// what a direction follows, and must outlive the call.
template <class Batch>
MotionOutput make_output(const Batch& batch, const py::dict& results, const py::object& vectors,
                         bool from_space) {
  MotionOutput out;
  const std::size_t states = batch.bodies * batch.times;
  for (const auto& [name, array] : results) {
    const auto key = py::cast<std::string>(name);
    const std::size_t width = key == "attitude" ? 4 : 3;
    const py::handle target = array;
    const auto set = [&]<class S>(MotionRows<S>& rows) {
      (key == "omega" ? rows.omega : key == "attitude" ? rows.attitude : rows.direction) =
          rows_of<S>(target, width * states);
    };
    if (py::isinstance<py::array_t<float>>(target)) {
      set(out.single);
    } else {
      set(out.rows);
    }
  }
  if (out.has_direction()) out.vector = py::cast<Array>(vectors).data();
  out.from_space = from_space;
  return out;
}

template <class Batch>
std::size_t run(Batch& batch, const MotionOutput& out, int threads, bool refuse, const py::object& progress,
                std::size_t (*motion)(const Batch&, const MotionOutput&, int)) {
  ReportedWork work(progress, batch.bodies * batch.times);
  batch.refuse = refuse, batch.done = work.done();
  const std::size_t failed = motion(batch, out, threads);
  work.finish();
  return failed;
}

std::size_t batch_free_motion(const py::object& inertia, const Array& omega, const Array& attitude, const Array& t,
                              const py::dict& results, const py::object& vectors, bool from_space, int threads,
                              bool refuse, const py::object& progress) {
  Array moments;
  auto batch = make_batch<FreeMotionBatch>(inertia, moments, omega, attitude, t);
  const MotionOutput out = make_output(batch, results, vectors, from_space);
  return run(batch, out, threads, refuse, progress, &free_motion);
}

std::size_t batch_gyrostat(const py::object& inertia, const Array& momentum, const Array& omega, const Array& attitude,
                           const Array& t, const py::dict& results, const py::object& vectors, bool from_space,
                           int threads, bool refuse, const py::object& progress) {
  Array moments;
  auto batch = make_batch<GyrostatBatch>(inertia, moments, omega, attitude, t);
  batch.momentum = momentum.data();
  const MotionOutput out = make_output(batch, results, vectors, from_space);
  return run(batch, out, threads, refuse, progress, &gyrostat);
}

std::size_t batch_heavy_top(const py::object& inertia, const Array& weight_arm, const Array& omega,
                            const Array& attitude, const Array& t, const py::dict& results,
                            const py::object& vectors, bool from_space, int threads, bool refuse,
                            const py::object& progress) {
  Array moments;
  auto batch = make_batch<HeavyTopBatch>(inertia, moments, omega, attitude, t);
  batch.weight_arm = weight_arm.data();
  const MotionOutput out = make_output(batch, results, vectors, from_space);
  return run(batch, out, threads, refuse, progress, &heavy_top);
}

/// Whether the value is n finite numbers: a plain float64 array, or a tuple or list of Python's numbers. Fills `numbers`.
template <std::size_t n>
bool read_numbers(py::handle value, std::array<double, n>& numbers) {
  PyObject* const object = value.ptr();
  if (Py_TYPE(object) == py::detail::npy_api::get().PyArray_Type_) {
    if (!is_plain(value)) return false;
    const auto array = py::reinterpret_borrow<Array>(value);
    if (array.ndim() != 1 || array.shape(0) != py::ssize_t{n}) return false;
    std::copy_n(array.data(), n, numbers.begin());
  } else if ((PyTuple_CheckExact(object) || PyList_CheckExact(object)) &&
             PySequence_Fast_GET_SIZE(object) == py::ssize_t{n}) {
    for (std::size_t i = 0; i < n; ++i) {
      PyObject* const item = PySequence_Fast_GET_ITEM(object, static_cast<py::ssize_t>(i));
      if (!PyFloat_CheckExact(item) && !PyLong_CheckExact(item)) return false;
      numbers[i] = PyFloat_AsDouble(item);
      if (numbers[i] == -1.0 && PyErr_Occurred()) {   // an integer beyond float64
        PyErr_Clear();
        return false;
      }
    }
  } else {
    return false;
  }
  return std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); });
}

/// omega and attitude of one body at a few times, without the cost of broadcasting; None for all that needs a second
/// look: other kinds of arguments, a processor that drops denormal numbers, and what a closed form refuses.
py::object free_motion_of_one(py::handle inertia, py::handle omega, py::handle attitude, py::handle t) {
  constexpr py::ssize_t most_times = 16384;   // from here on the motion costs far more than the call
  std::array<double, 3> I{}, w{};
  std::array<double, 4> q{};
  if (Py_TYPE(t.ptr()) != py::detail::npy_api::get().PyArray_Type_ || !is_plain(t)) return py::none();
  const auto times = py::reinterpret_borrow<Array>(t);
  if (flushes_to_zero() || times.size() == 0 || times.size() > most_times || !read_numbers(inertia, I) ||
      !read_numbers(omega, w) || !read_numbers(attitude, q) || q == std::array{1.0, 0.0, 0.0, 0.0}) {
    return py::none();
  }
  FreeMotionBatch batch;
  batch.bodies = 1, batch.times = static_cast<std::size_t>(times.size());
  batch.moments = I.data(), batch.omega = w.data(), batch.attitude = q.data(), batch.t = times.data();
  Array omegas = result_for(times, 3), attitudes = result_for(times, 4);
  try {
    if (free_motion(batch, omegas.mutable_data(), attitudes.mutable_data(), 1) > 0) return py::none();
    return py::make_tuple(omegas, attitudes);
  } catch (const InvalidInput&) {
    return py::none();
  }
}

}  // namespace

void bind_batch(py::module_& m) {
  m.def("_free_motion", &batch_free_motion);
  m.def("_free_motion_of_one", &free_motion_of_one);
  m.def("_gyrostat", &batch_gyrostat);
  m.def("_heavy_top", &batch_heavy_top);
}

}  // namespace polhode::python
