#include <memory>

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

}  // namespace

std::vector<Window> to_windows(py::handle value, const char* name) {
  const Array array = to_array(value, name);
  const bool pairs = array.ndim() == 2 && array.shape(1) == 2, one = array.ndim() == 1 && array.shape(0) == 2;
  if (!pairs && !one && array.size() != 0) {
    throw InvalidInput(name, "pairs (begin, end)", "shape " + std::string(py::str(array.attr("shape"))));
  }
  std::vector<Window> windows;
  for (py::ssize_t i = 0; i + 1 < array.size(); i += 2) windows.push_back({array.data()[i], array.data()[i + 1]});
  return windows;
}

py::tuple from_windows(std::span<const Window> windows) {
  py::tuple pairs(windows.size());
  for (std::size_t i = 0; i < windows.size(); ++i) pairs[i] = py::make_tuple(windows[i].begin, windows[i].end);
  return pairs;
}

namespace {

std::unique_ptr<OwnDuring> make_during(const py::object& torque, py::handle windows) {
  During during(to_lasting(torque), to_windows(windows, "During.windows"));
  return std::unique_ptr<OwnDuring>(new OwnDuring{torque, std::move(during)});
}

py::tuple get_during_state(const OwnDuring& own) {
  return py::make_tuple(own.inner, from_windows(own.torque.windows()));
}

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
    A begin and a later end each [s], in any order; either may be infinite. Windows that touch are one. An empty list
    means that the torque never acts.

Raises
------
InvalidInput
    For a window that is empty, reversed or not a number, for two that overlap, and for what is no torque.
)doc";

}  // namespace

void bind_torque_during(py::module_& m) {
  py::class_<OwnDuring> type(m, "During", during_doc, py::custom_type_setup(&show_references<OwnDuring>));
  bind_value(type);
  type.def(py::init(&make_during), py::arg("torque"), py::arg("windows"))
      .def_property_readonly("torque", [](const OwnDuring& own) { return own.inner; }, "The torque that acts.")
      .def_property_readonly("windows", [](const OwnDuring& own) { return from_windows(own.torque.windows()); },
                             "tuple of (begin, end) [s], in the order of time.")
      .def_property_readonly("traits", [](const OwnDuring& own) { return describe_traits(own.torque.traits()); },
                             "dict: uses_time, uses_attitude, uses_rates, has_potential.")
      .def("__repr__",
           [](const OwnDuring& own) {
             return "polhode.torques.During(" + std::string(py::repr(own.inner)) +
                    ", windows=" + std::string(py::repr(from_windows(own.torque.windows()))) + ")";
           })
      .def("__eq__",
           [](const OwnDuring& a, const py::object& b) {
             return py::isinstance<OwnDuring>(b) &&
                    get_during_state(a).equal(get_during_state(b.cast<const OwnDuring&>()));
           })
      .def("__hash__", [](const OwnDuring& own) { return py::hash(get_during_state(own)); })
      .def(py::pickle(&get_during_state, [](const py::tuple& state) {
        return from_state("During", state, 2, [](const py::tuple& s) {
          return make_during(py::reinterpret_borrow<py::object>(s[0]), s[1]);
        });
      }));
}

}  // namespace polhode::python
