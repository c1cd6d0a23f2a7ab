#pragma once

#include <pybind11/pybind11.h>

namespace polhode::python {

namespace py = pybind11;

void bind_core(py::module_& m);
void bind_math(py::module_& m);
void bind_attitude(py::module_& m);
void bind_inertia(py::module_& m);
void bind_inertia_checks(py::module_& m);
void bind_torque(py::module_& m);
void bind_exact(py::module_& m);
void bind_ode(py::module_& m);
void bind_clock(py::module_& m);
void bind_scene(py::module_& m);
void bind_solve(py::module_& m);
void bind_solve_sensitivity(py::module_& m);
void bind_spectrum(py::module_& m);
void bind_orbit(py::module_& m);
void bind_batch(py::module_& m);
void bind_batch_draw(py::module_& m);
void bind_batch_summary(py::module_& m);
void bind_batch_step(py::module_& m);
void bind_batch_solve_many(py::module_& m);

}  // namespace polhode::python
