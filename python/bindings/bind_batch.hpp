#pragma once

#include <cstddef>

#include "convert.hpp"
#include "polhode/inertia/inertia_tensor.hpp"

// What the batches of closed forms share on their way from Python.
namespace polhode::python {

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

}  // namespace polhode::python
