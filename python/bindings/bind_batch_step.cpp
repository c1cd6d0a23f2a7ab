#include <vector>

#include "convert.hpp"
#include "gil.hpp"
#include "polhode/batch/step.hpp"

namespace polhode::python {
namespace {

/// Python has checked shapes, types and order, and made what is not the caller's. Both outputs hold the start.
template <class T>
void step_rows(const py::array_t<T>& moments, py::array_t<T>& momentum, py::array_t<T>& attitude, double step,
               const py::object& torque, bool space, long count, double first, double last, int threads) {
  StepBatch<T> batch;
  batch.bodies = static_cast<std::size_t>(momentum.size()) / 3;
  batch.moments = moments.data(), batch.one_inertia = moments.ndim() == 1;
  py::array_t<T> kicks;
  if (!torque.is_none()) {
    kicks = torque.cast<py::array_t<T>>();
    batch.torque = kicks.data(), batch.one_torque = kicks.ndim() == 1;
  }
  batch.space = space, batch.step = static_cast<T>(step), batch.count = count, batch.first = first, batch.last = last;
  batch.momentum = momentum.mutable_data(), batch.attitude = attitude.mutable_data();
  const WithoutGil nogil;
  step_bodies(batch, threads);
}

/// q_AB (..., 4) times q_BC, of the same shape or (4).
template <class T>
py::array_t<T> multiply(const py::array_t<T, plain>& q_AB, const py::array_t<T, plain>& q_BC) {
  py::array_t<T> q_AC(std::vector<py::ssize_t>(q_AB.shape(), q_AB.shape() + q_AB.ndim()));
  multiply_attitudes(static_cast<std::size_t>(q_AB.size()) / 4, q_AB.data(), q_BC.data(), q_BC.ndim() == 1 ? 0 : 4,
                     q_AC.mutable_data());
  return q_AC;
}

}  // namespace

void bind_batch_step(py::module_& m) {
  m.def("_step_f", &step_rows<float>);
  m.def("_step_d", &step_rows<double>);
  m.def("_multiply_f", &multiply<float>);
  m.def("_multiply_d", &multiply<double>);
}

}  // namespace polhode::python
