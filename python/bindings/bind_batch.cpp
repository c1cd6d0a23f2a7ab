#include "convert.hpp"
#include "gil.hpp"
#include "polhode/batch/free_motion.hpp"
#include "polhode/batch/gyrostat.hpp"
#include "polhode/batch/heavy_top.hpp"
#include "polhode/core/error.hpp"

namespace polhode::python {
namespace {

/// The output array of a batch, or null; the size is that of the result.
template <class Batch>
double* target(const Batch& batch, const py::object& out, std::size_t width) {
  if (out.is_none()) return nullptr;
  auto array = py::cast<py::array_t<double, py::array::c_style>>(out);
  if (static_cast<std::size_t>(array.size()) != batch.bodies * batch.times * width) {
    throw InvalidInput("out", "of the result's size", "another");
  }
  return array.mutable_data();
}

/// Python brings everything to (bodies, ...) and (times,) or (bodies, times); outputs are written in place. `inertia`
/// is the InertiaTensor of all bodies or (bodies, 3) moments, and `moments` keeps the latter alive.
template <class Batch>
Batch make_batch(const py::object& inertia, Array& moments, const Array& omega, const Array& attitude, const Array& t) {
  Batch batch;
  batch.bodies = static_cast<std::size_t>(omega.shape(0));
  batch.own_times = t.ndim() == 2;
  batch.times = static_cast<std::size_t>(t.shape(t.ndim() - 1));
  batch.omega = omega.data(), batch.attitude = attitude.data(), batch.t = t.data();
  if (py::isinstance<InertiaTensor>(inertia)) {
    batch.tensor = &inertia.cast<const InertiaTensor&>();
  } else {
    moments = inertia.cast<Array>();
    batch.moments = moments.data();
  }
  return batch;
}

std::size_t batch_free_motion(const py::object& inertia, const Array& omega, const Array& attitude, const Array& t,
                              const py::object& omega_out, const py::object& attitude_out, int threads) {
  Array moments;
  const auto batch = make_batch<FreeMotionBatch>(inertia, moments, omega, attitude, t);
  double *w = target(batch, omega_out, 3), *q = target(batch, attitude_out, 4);
  const WithoutGil nogil;
  return free_motion(batch, w, q, threads);
}

std::size_t batch_gyrostat(const py::object& inertia, const Array& momentum, const Array& omega, const Array& attitude,
                           const Array& t, const py::object& omega_out, const py::object& attitude_out, int threads) {
  Array moments;
  auto batch = make_batch<GyrostatBatch>(inertia, moments, omega, attitude, t);
  batch.momentum = momentum.data();
  double *w = target(batch, omega_out, 3), *q = target(batch, attitude_out, 4);
  const WithoutGil nogil;
  return gyrostat(batch, w, q, threads);
}

std::size_t batch_heavy_top(const py::object& inertia, const Array& weight_arm, const Array& omega,
                            const Array& attitude, const Array& t, const py::object& omega_out,
                            const py::object& attitude_out, int threads) {
  Array moments;
  auto batch = make_batch<HeavyTopBatch>(inertia, moments, omega, attitude, t);
  batch.weight_arm = weight_arm.data();
  double *w = target(batch, omega_out, 3), *q = target(batch, attitude_out, 4);
  const WithoutGil nogil;
  return heavy_top(batch, w, q, threads);
}

}  // namespace

void bind_batch(py::module_& m) {
  m.def("_free_motion", &batch_free_motion);
  m.def("_gyrostat", &batch_gyrostat);
  m.def("_heavy_top", &batch_heavy_top);
}

}  // namespace polhode::python
