#pragma once

#include "bind.hpp"
#include "polhode/inertia/inertia_tensor.hpp"
#include "polhode/scene/changing.hpp"
#include "polhode/scene/damper.hpp"
#include "polhode/scene/rotor.hpp"
#include "polhode/torque/torques.hpp"

namespace polhode::python {

/// An InertiaTensor, three principal moments in the body axes, or a (3, 3) tensor.
InertiaTensor to_inertia(py::handle value, const char* name);

/// The torque of a Python object. The object must outlive all copies of the torque.
AnyTorque to_torque(py::handle value, const std::string& name);

/// polhode.Rotor: a wheel in a body.
void bind_scene_rotor(py::module_& m);
void bind_scene_damper(py::module_& m);
void bind_scene_changing(py::module_& m);
std::optional<Changing> to_changing(py::handle value, const char* name);
std::optional<Damper> to_damper(py::handle value);
Rotor to_rotor(py::handle value, const std::string& name);

/// Windows of time: pairs (begin, end), or one pair.
std::vector<torques::Window> to_windows(py::handle value, const char* name);
py::tuple from_windows(std::span<const torques::Window> windows);

}  // namespace polhode::python
