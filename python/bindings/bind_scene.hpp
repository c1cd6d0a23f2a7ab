#pragma once

#include "bind.hpp"
#include "polhode/inertia/inertia_tensor.hpp"
#include "polhode/torque/torques.hpp"

namespace polhode::python {

/// An InertiaTensor, three principal moments in the body axes, or a (3, 3) tensor.
InertiaTensor to_inertia(py::handle value, const char* name);

/// The torque of a Python object. The object must outlive all copies of the torque.
AnyTorque to_torque(py::handle value, const std::string& name);

}  // namespace polhode::python
