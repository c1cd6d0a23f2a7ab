#include "bind.hpp"
#include "calls.hpp"

// The table of contents: one line a word, in the order in which they may use each other.
PYBIND11_MODULE(_core, m, pybind11::mod_gil_not_used()) {
  m.doc() = "The compiled core of polhode. Use the names of the package `polhode`, not these.";
  using namespace polhode::python;
  bind_core(m);
  bind_math(m);
  bind_attitude(m);
  bind_inertia(m);
  bind_inertia_checks(m);
  bind_torque(m);
  bind_exact(m);
  bind_ode(m);
  bind_scene(m);
  bind_solve(m);
  bind_batch(m);
  bind_batch_solve_many(m);
  refuse_wrong_calls(m);
}
