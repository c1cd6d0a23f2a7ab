#include "bind.hpp"

namespace polhode::python {

void bind_exact_damped_free(py::module_& m);
void bind_exact_free_motion(py::module_& m);
void bind_exact_gyrostat(py::module_& m);
void bind_exact_free_sensitivity(py::module_& m);
void bind_exact_heavy_top(py::module_& m);
void bind_exact_pendulum(py::module_& m);

void bind_exact(py::module_& m) {
  bind_exact_free_motion(m);
  bind_exact_gyrostat(m);
  bind_exact_damped_free(m);
  bind_exact_free_sensitivity(m);
  bind_exact_heavy_top(m);
  bind_exact_pendulum(m);
}

}  // namespace polhode::python
