#include "bind_scene.hpp"
#include "bind_torque.hpp"
#include "convert.hpp"
#include "polhode/core/error.hpp"

// polhode.torques.During: another torque, within windows of time.
namespace polhode::python {
namespace {

using torques::During;
using torques::Window;

LastingTorque to_lasting(py::handle value) {
  return std::visit(
      []<class T>(const T& one) -> LastingTorque {
        if constexpr (std::is_same_v<T, During>) {
          throw InvalidInput("During.torque", "a torque without windows", "During", "give the windows that both share");
        } else {
          return one;
        }
      },
      to_torque(value, "During.torque"));
}

std::vector<Window> to_windows(py::handle value) {
  const Array array = to_array(value, "During.windows");
  const bool pairs = array.ndim() == 2 && array.shape(1) == 2, one = array.ndim() == 1 && array.shape(0) == 2;
  if (!pairs && !one && array.size() != 0) {
    throw InvalidInput("During.windows", "pairs (begin, end)", "shape " + std::string(py::str(array.attr("shape"))));
  }
  std::vector<Window> windows;
  for (py::ssize_t i = 0; i + 1 < array.size(); i += 2) windows.push_back({array.data()[i], array.data()[i + 1]});
  return windows;
}

py::tuple from_windows(const During& torque) {
  py::tuple windows(torque.windows().size());
  for (std::size_t i = 0; i < torque.windows().size(); ++i) {
    windows[i] = py::make_tuple(torque.windows()[i].begin, torque.windows()[i].end);
  }
  return windows;
}

py::object get_torque(const During& torque) {
  return from_torque(std::visit([](const auto& one) { return AnyTorque(one); }, torque.torque()));
}

py::tuple get_during_state(const During& torque) { return py::make_tuple(get_torque(torque), from_windows(torque)); }

constexpr const char* during_doc =
    R"doc(During(torque, windows)

Another torque within windows of time, and none outside: a thruster's firings, a brake that is let go.

The span is cut where windows begin and end. Each piece has the torques that act there: where that leaves a closed form
(a free body coasts between firings) it is evaluated, else it is stepped, and no step goes over a jump.

Parameters
----------
torque : a torque of polhode.torques
    Without windows of its own.
windows : array_like, shape (n, 2) or (2,)
    A begin and a later end each [s], in any order; either may be infinite. Windows that touch are one.

Raises
------
InvalidInput
    For a window that is empty, reversed or not a number, for two that overlap, and for what is no torque.
)doc";

}  // namespace

void bind_torque_during(py::module_& m) {
  py::class_<During>(m, "During", during_doc)
      .def(py::init([](const py::object& torque, const py::object& windows) {
             return During(to_lasting(torque), to_windows(windows));
           }),
           py::arg("torque"), py::arg("windows"))
      .def_property_readonly("torque", &get_torque, "The torque that acts.")
      .def_property_readonly("windows", &from_windows, "tuple of (begin, end) [s], in the order of time.")
      .def_property_readonly(
          "traits", [](const During& torque) { return describe_traits(torque.traits()); },
          "dict: uses_time, uses_attitude, uses_rates, has_potential.")
      .def("__repr__",
           [](const During& torque) {
             return "polhode.torques.During(" + std::string(py::repr(get_torque(torque))) +
                    ", windows=" + std::string(py::repr(from_windows(torque))) + ")";
           })
      .def("__eq__",
           [](const During& a, const py::object& b) {
             return py::isinstance<During>(b) && get_during_state(a).equal(get_during_state(b.cast<const During&>()));
           })
      .def("__hash__", [](const During& torque) { return py::hash(get_during_state(torque)); })
      .def(py::pickle(&get_during_state,
                      [](const py::tuple& state) { return During(to_lasting(state[0]), to_windows(state[1])); }));
}

}  // namespace polhode::python
