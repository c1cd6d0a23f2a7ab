#pragma once

#include "bind.hpp"
#include "polhode/torque/record.hpp"

namespace polhode::python {

/// polhode.torques.Custom: a Python callable, or a compiled function pointer from numba, ctypes or C++.
void bind_torque_custom(py::module_& m);

/// polhode.torques.During: another torque, within windows of time.
void bind_torque_during(py::module_& m);

/// What a torque looks at, as `torque.traits` shows it.
inline py::dict describe_traits(const TorqueTraits& traits) {
  py::dict dict;
  dict["uses_time"] = traits.uses_time;
  dict["uses_attitude"] = traits.uses_attitude;
  dict["uses_rates"] = traits.uses_rates;
  dict["has_potential"] = traits.has_potential;
  return dict;
}

}  // namespace polhode::python
