#include "bind_exact.hpp"

namespace polhode::python {

void bind_exact_free_sensitivity(py::module_& m);

void bind_exact(py::module_& m) {
#define POLHODE_BIND(type) bind_closed_form<type>(m);
  POLHODE_CLOSED_FORM_TYPES(POLHODE_BIND)
#undef POLHODE_BIND
  bind_exact_free_sensitivity(m);
}

}  // namespace polhode::python
