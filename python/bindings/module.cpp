#include <pybind11/numpy.h>

#include <vector>

#include "bind.hpp"
#include "calls.hpp"
#include "polhode/inertia/shapes.hpp"
#include "polhode/method/methods.hpp"
#include "reduce.hpp"
#include "uninitialised.hpp"

namespace polhode::python {
namespace {

/// The compiled classes of the module and of its torques.
std::vector<py::type> list_classes(const py::module_& m) {
  std::vector<py::type> classes;
  for (const py::module_& part : {m, m.attr("torques").cast<py::module_>()}) {
    for (const auto& item : py::dict(part.attr("__dict__"))) {
      PyObject* const value = item.second.ptr();
      if (!PyType_Check(value) || PyExceptionClass_Check(value)) continue;
      if (py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(value)) == nullptr) continue;
      classes.push_back(py::reinterpret_borrow<py::type>(value));
    }
  }
  return classes;
}

/// What would be made at the first call, behind a lock. A thread that makes it while the process forks would leave the
/// lock closed in the child.
void make_constants() {
  py::detail::npy_api::get();
  methods();
  shapes::all();
}

}  // namespace
}  // namespace polhode::python

extern "C" PYBIND11_EXPORT PyObject* PyInit_polhode_core();

// pybind11's own start waits for ever in a subinterpreter, and NumPy supports none.
extern "C" PYBIND11_EXPORT PyObject* PyInit__core() {
  if (PyInterpreterState_Get() == PyInterpreterState_Main()) return PyInit_polhode_core();
  PyErr_SetString(PyExc_ImportError,
                  "polhode cannot be imported in a subinterpreter, as NumPy and pybind11 keep one state for the whole "
                  "process; import it in the main interpreter, or use processes");
  return nullptr;
}

// The table of contents: one line a word, in the order in which they may use each other.
PYBIND11_MODULE(polhode_core, m, pybind11::mod_gil_not_used()) {
  m.doc() = "The compiled core of polhode. Use the names of the package `polhode`, not these.";
  using namespace polhode::python;
  make_constants();
  bind_core(m);
  bind_math(m);
  bind_attitude(m);
  bind_inertia(m);
  bind_inertia_checks(m);
  bind_torque(m);
  bind_exact(m);
  bind_ode(m);
  bind_clock(m);
  bind_scene(m);
  bind_solve(m);
  bind_solve_sensitivity(m);
  bind_spectrum(m);
  bind_orbit(m);
  bind_batch(m);
  bind_batch_draw(m);
  bind_batch_summary(m);
  bind_batch_step(m);
  bind_batch_solve_many(m);
  const std::vector<py::type> classes = list_classes(m);
  refuse_wrong_calls(classes);
  reduce_by_state(classes);
  guard_uninitialised(classes, m.attr("InvalidInput"));
}
