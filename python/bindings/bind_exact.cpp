#include "bind_exact.hpp"

namespace polhode::python {

void bind_exact_free_sensitivity(py::module_& m);

void bind_exact(py::module_& m) {
  py::module_ forms = m.def_submodule("exact", "The classes of the closed forms.");
  py::class_<AnyForm>(forms, "_ClosedForm", "A closed form.");
#define POLHODE_BIND(type) bind_closed_form<type>(forms), m.attr(#type) = forms.attr(#type);
  POLHODE_CLOSED_FORM_TYPES(POLHODE_BIND)
#undef POLHODE_BIND
  bind_exact_free_sensitivity(m);
}

}  // namespace polhode::python
