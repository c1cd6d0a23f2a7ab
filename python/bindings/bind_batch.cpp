#include "convert.hpp"
#include "polhode/batch/free_motion.hpp"
#include "polhode/core/error.hpp"

namespace polhode::python {
namespace {

/// polhode.batch brings everything to (bodies, ...) and (times,) or (bodies, times); outputs are written in place.
std::size_t batch_free_motion(const Array& moments, const Array& omega, const Array& attitude, const Array& t,
                              const py::object& omega_out, const py::object& attitude_out, int threads) {
  FreeMotionBatch batch;
  batch.bodies = static_cast<std::size_t>(moments.shape(0));
  batch.own_times = t.ndim() == 2;
  batch.times = static_cast<std::size_t>(t.shape(t.ndim() - 1));
  batch.moments = moments.data(), batch.omega = omega.data(), batch.attitude = attitude.data(), batch.t = t.data();
  const auto target = [&batch](const py::object& out, std::size_t width) -> double* {
    if (out.is_none()) return nullptr;
    auto array = py::cast<py::array_t<double, py::array::c_style>>(out);
    if (static_cast<std::size_t>(array.size()) != batch.bodies * batch.times * width) throw InvalidInput("out", "of the result's size", "another");
    return array.mutable_data();
  };
  double *w = target(omega_out, 3), *q = target(attitude_out, 4);
  py::gil_scoped_release nogil;
  return free_motion(batch, w, q, threads);
}

}  // namespace

void bind_batch(py::module_& m) { m.def("_free_motion", &batch_free_motion); }

}  // namespace polhode::python
