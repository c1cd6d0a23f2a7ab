#include "bind_scene.hpp"

#include <pybind11/stl.h>

#include <algorithm>

#include "bind_clock.hpp"
#include "bind_torque.hpp"
#include "convert.hpp"
#include "polhode/core/error.hpp"
#include "polhode/scene/scene.hpp"

namespace polhode::python {
namespace {

std::vector<double> to_times(py::handle value) {
  const Array array = to_array(value, "scene.times");
  if (array.ndim() != 1)
    throw InvalidInput("scene.times", "a one-dimensional array", std::to_string(array.ndim()) + " dimensions");
  return {array.data(), array.data() + array.size()};
}

Wanted to_wanted(py::handle value) {
  Wanted want{false, false};
  const auto take = [&](const std::string& name) {
    if (name != "omega" && name != "attitude")
      throw InvalidInput("scene.want", "'omega', 'attitude' or both", "'" + name + "'");
    (name == "omega" ? want.omega : want.attitude) = true;
  };
  if (py::isinstance<py::str>(value)) {
    take(value.cast<std::string>());
  } else {
    if (!py::isinstance<py::iterable>(value)) {
      throw InvalidInput("scene.want", "'omega', 'attitude' or both", std::string(py::repr(value)));
    }
    for (const py::handle one : py::iter(value)) take(std::string(py::str(one)));
  }
  return want;
}

Array view(const std::vector<double>& values, const py::object& base) {
  Array array(py::array::ShapeContainer{static_cast<py::ssize_t>(values.size())}, values.data(), base);
  array.attr("flags").attr("writeable") = false;
  return array;
}

/// The sum of the torques at one state, or row by row; single values hold for all rows.
Array torque_of(const Scene& scene, const py::object& t, const py::object& omega, const py::object& attitude,
                const py::object& states) {
  std::vector<AnyTorque> torques = scene.given_torques();
  if (!states.is_none()) set_starts(torques, scene.states(), to_state_numbers(scene.states(), states));
  const SeveralTorques sum{torques};
  const bool rotation = !PyType_Check(attitude.ptr()) && py::hasattr(attitude, "as_quat");
  const py::object quats = rotation ? py::object(attitude.attr("as_quat")()) : attitude;
  const Array at = to_array(t, "t"), w = to_array(omega, "omega"), q = to_array(quats, "attitude");
  if (at.ndim() == 0 && w.ndim() < 2 && q.ndim() < 2) {
    const Vector3d rates = to_vector3(omega, "omega");
    const Quat unit = to_attitude(attitude, "attitude");
    const double all[4] = {unit.x, unit.y, unit.z, unit.w}, time = to_real(t, "t");
    Vector3d tau = Vector3d::Zero();
    sum.add(TorqueInput{time, rates.data(), all, scene.inertia_B(time)}, tau.data());
    return from_vector3(tau);
  }
  py::ssize_t n = -1;
  const auto count = [&](const Array& array, py::ssize_t axes, py::ssize_t width, const char* name) {
    const bool fits = array.ndim() == axes || array.ndim() == axes - 1;
    if (!fits || (axes == 2 && array.shape(array.ndim() - 1) != width) ||
        (array.ndim() == axes && n >= 0 && array.shape(0) != n))
      throw InvalidInput(name, "one row, or as many as the other arrays",
                         "shape " + std::string(py::str(array.attr("shape"))));
    if (array.ndim() == axes) n = array.shape(0);
    require_finite(array, name);
  };
  count(at, 1, 1, "t"), count(w, 2, 3, "omega"), count(q, 2, 4, "attitude");
  Array found({n, py::ssize_t{3}});
  for (py::ssize_t i = 0; i < n; ++i) {
    const auto row = [i](const Array& array, py::ssize_t axes, py::ssize_t width) {
      return array.data() + (array.ndim() == axes ? i * width : 0);
    };
    const double* given = row(q, 2, 4);
    const Quat unit = make_attitude({given[0], given[1], given[2], given[3]});
    const double all[4] = {unit.x, unit.y, unit.z, unit.w}, time = *row(at, 1, 1);
    double* tau = found.mutable_data() + 3 * i;
    std::fill_n(tau, 3, 0.0);
    sum.add(TorqueInput{time, row(w, 2, 3), all, scene.inertia_B(time)}, tau);
    if (i % 4096 == 4095 && PyErr_CheckSignals() != 0) throw py::error_already_set();
  }
  return found;
}

}  // namespace

InertiaTensor to_inertia(py::handle value, const char* name) {
  if (py::isinstance<InertiaTensor>(value)) return value.cast<const InertiaTensor&>();
  const Array array = to_array(value, name);
  if (array.ndim() == 1 && array.shape(0) == 3) return InertiaTensor::from_moments(to_vector3(array, name));
  return InertiaTensor(to_tensor(array, name));
}

void bind_scene(py::module_& m) {
  bind_scene_rotor(m);
  bind_scene_damper(m);
  bind_scene_changing(m);
  // The Python class keeps the torques' objects, so that their functions live as long.
  py::class_<Scene>(m, "Scene")
      .def(py::init([](py::handle inertia, py::handle omega, py::handle attitude, const py::iterable& torques,
                       py::handle times, py::handle want, py::handle t0, const py::object& name,
                       const py::iterable& rotors, py::handle damper, py::handle momentum, bool leaving,
                       const py::iterable& controllers) {
             if (!py::isinstance<py::str>(name)) throw InvalidInput("scene.name", "text", std::string(py::repr(name)));
             if (PyUnicode_AsUTF8(name.ptr()) == nullptr) {
               PyErr_Clear();
               throw InvalidInput("scene.name", "text that UTF-8 can write", std::string(py::str(py::repr(name))),
                                  "part of a file name in another encoding");
             }
             std::vector<AnyTorque> list;
             for (const py::handle one : torques)
               list.push_back(to_torque(one, "scene.torques[" + std::to_string(list.size()) + "]"));
             std::vector<Rotor> wheels;
             for (const py::handle rotor : rotors)
               wheels.push_back(to_rotor(rotor, "scene.rotors[" + std::to_string(wheels.size()) + "]"));
             std::vector<Controller> clocks;
             for (const py::handle one : controllers)
               clocks.push_back(to_controller(one, "scene.controllers[" + std::to_string(clocks.size()) + "]"));
             std::optional<Changing> changing;
             if (py::isinstance<Changing>(inertia)) changing = to_changing(inertia, "scene.inertia");
             // The scene takes the tensor of its start.
             const InertiaTensor body = changing ? InertiaTensor::from_moments(Vector3d::Ones())
                                                 : to_inertia(inertia, "scene.inertia");
             return Scene(SceneParts{body, to_vector3(omega, "scene.omega"),
                                     to_attitude(attitude, "scene.attitude", 3), std::move(list), to_times(times),
                                     to_wanted(want), to_real(t0, "scene.t0"), name.cast<std::string>(),
                                     std::move(wheels), to_damper(damper), std::move(changing),
                                     to_changing(momentum, "scene.momentum"), leaving, std::move(clocks)});
           }),
           py::arg("inertia"), py::arg("omega"), py::arg("attitude"), py::arg("torques"), py::arg("times"),
           py::arg("want"), py::arg("t0"), py::arg("name"), py::arg("rotors"),
           py::arg("damper"), py::arg("momentum"), py::arg("leaving"),
           py::arg("controllers") = py::tuple())
      .def_property_readonly("inertia", py::overload_cast<>(&Scene::given_inertia_B, py::const_))
      .def_property_readonly("carrier_inertia", py::overload_cast<>(&Scene::inertia_B, py::const_),
                             "InertiaTensor J that moves with omega: `inertia` less the axial moments of free rotors and the damper's.")
      .def_property_readonly("changing", &Scene::changing,
                             "The inertia of a body that changes, or None. `inertia` is then that of the start.")
      .def_property_readonly("momentum", &Scene::momentum, "The momentum of parts inside the body, or None.")
      .def_property_readonly("leaving", &Scene::leaving, "Whether matter that leaves takes its momentum along.")
      .def_property_readonly("damper", &Scene::given_damper, "The viscous slug in the body, or None.")
      .def_property_readonly(
          "rotor_momentum", [](const Scene& scene) { return from_vector3(scene.rotor_momentum()); },
          "h, the sum of the rotors' momenta in body axes at the start, shape (3,) [kg m^2/s].")
      .def_property_readonly("rotors",
                             [](const Scene& scene) {
                               py::list list;
                               for (const Rotor& rotor : scene.rotors()) list.append(rotor.as_given());
                               return py::tuple(list);
                             })
      .def_property_readonly("omega", [](const Scene& scene) { return from_vector3(scene.omega()); })
      .def_property_readonly("attitude", [](const Scene& scene) { return from_quat(scene.attitude()); })
      .def_property_readonly("times",
                             [](const py::object& self) { return view(self.cast<const Scene&>().times(), self); })
      .def_property_readonly("want",
                             [](const Scene& scene) {
                               py::list list;
                               if (scene.want().omega) list.append("omega");
                               if (scene.want().attitude) list.append("attitude");
                               return py::tuple(list);
                             })
      .def_property_readonly("states", [](const Scene& scene) {
        py::dict all;
        for (const formula::Input& state : scene.states()) {
          const auto count = static_cast<py::ssize_t>(state.values.size());
          all[py::str(state.name)] = count == 1 ? py::object(py::float_(state.values[0]))
                                                : py::object(Array(count, state.values.data()));
        }
        return all;
      }, "dict: the starts of the states that formulas have, by name.")
      .def("torque", &torque_of, py::arg("t"), py::arg("omega"), py::arg("attitude"), py::arg("states") = py::none(),
           R"doc(Return the sum of the torques at one state, or at many.

Parameters
----------
t : float, or array_like of shape (n,)
    Time [s].
omega : array_like, shape (3,) or (n, 3)
    Rates in body axes [rad/s].
attitude : array_like, shape (4,) or (n, 4)
    Unit quaternions (x, y, z, w).
states : dict, optional
    Numbers of the formulas' states by name; the starts if left out.

Returns
-------
ndarray, shape (3,) or (n, 3)
    In body axes [N m], without the torques of rotors.
)doc")
      .def_property_readonly("t0", &Scene::t0)
      .def_property_readonly("name", &Scene::name);
}

}  // namespace polhode::python
