#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "bind_formula.hpp"
#include "bind_orbit.hpp"
#include "bind_torque.hpp"
#include "convert.hpp"
#include "polhode/core/error.hpp"
#include "polhode/torque/formula.hpp"

// polhode.torques.Formula.
namespace polhode::python {
namespace {

using formula::Input;
using formula::Text;
using torques::Formula;

bool to_choice(py::handle value) {
  if (!py::isinstance<py::bool_>(value))
    throw InvalidInput("Formula.recognise", "True or False", std::string(py::repr(value)));
  return value.cast<bool>();
}

void require_free_names(const std::vector<Input>& inputs) {
  for (const Input& input : inputs)
    if (input.name == "scale")   // the others are arguments
      throw InvalidInput("Formula." + input.name, "named otherwise", "a reserved name");
}

/// States of a text: each a dict of start and rate.
void add_states(const py::dict& states, Text& text) {
  py::dict starts;
  for (const auto& [name, state] : states) {
    const std::string where = "Formula.states." + std::string(py::str(name));
    if (!py::isinstance<py::dict>(state) || !state.contains("start") || !state.contains("rate") || py::len(state) != 2)
      throw InvalidInput(where, "{\"start\": numbers, \"rate\": text} beside a text", std::string(py::repr(state)));
    starts[name] = state["start"];
  }
  text.states = to_inputs(starts, "Formula.states.");
  for (const Input& input : text.states)
    text.rates.push_back(to_field(states[py::str(input.name)]["rate"], "Formula.states." + input.name + ".rate"));
}

/// Orbits by their names in a text.
std::vector<std::pair<std::string, formula::Ephemeris>> to_orbits(py::handle orbits) {
  std::vector<std::pair<std::string, formula::Ephemeris>> found;
  if (orbits.is_none()) return found;
  if (!py::isinstance<py::dict>(orbits))
    throw InvalidInput("Formula.orbits", "a dict of names and orbits", std::string(py::str(py::type::of(orbits))));
  for (const auto& [key, orbit] : py::reinterpret_borrow<py::dict>(orbits)) {
    const std::string name = to_field(key, "Formula.orbits");
    found.emplace_back(name, to_ephemeris(orbit, "Formula.orbits." + name, name));
  }
  return found;
}

py::dict from_orbits(const Text& text) {
  py::dict dict;
  for (const auto& [name, orbit] : text.orbits) dict[py::str(name)] = from_ephemeris(orbit);
  return dict;
}

py::dict to_states(py::handle states) {
  if (states.is_none()) return {};
  if (!py::isinstance<py::dict>(states))
    throw InvalidInput("Formula.states", "a dict of names and starts", std::string(py::str(py::type::of(states))));
  return py::reinterpret_borrow<py::dict>(states);
}

Formula make_formula(const py::object& function, const py::object& text, const py::object& let,
                     const py::object& potential, const py::object& states, const py::object& orbits,
                     const py::object& recognise, const py::kwargs& parameters) {
  const bool may = to_choice(recognise);
  const int given = !function.is_none() + !text.is_none() + !potential.is_none();
  if (given != 1)
    throw InvalidInput("Formula", "given a function, text= or potential=, one of them",
                       given == 0 ? "none" : "several");
  const std::vector<Input> inputs = to_inputs(parameters);
  require_free_names(inputs);
  const py::dict own = to_states(states);
  const bool is_text = !text.is_none() || py::isinstance<py::str>(potential);
  if (!potential.is_none() && own.size() > 0)
    throw InvalidInput("Formula.states", "left out for a potential", std::string(py::repr(own)));
  if (is_text) {
    Text written{text.is_none() ? "" : to_field(text, "Formula.text"), inputs, {}, {}, to_let(let, "Formula.let")};
    if (text.is_none()) written.potential = to_field(potential, "Formula.potential");
    if (written.torque.empty() && written.potential.empty())
      throw InvalidInput("Formula", "a text with an expression", "an empty one");
    written.orbits = to_orbits(orbits);
    add_states(own, written);
    return Formula(written, may);
  }
  if (!let.is_none()) throw InvalidInput("Formula.let", "left out for a function", std::string(py::repr(let)));
  if (!orbits.is_none())
    throw InvalidInput("Formula.orbits", "left out for a function", std::string(py::repr(orbits)), "call orbit.at(t) in it");
  const py::object& called = potential.is_none() ? function : potential;
  if (!PyCallable_Check(called.ptr())) {
    const bool torque = potential.is_none();
    throw InvalidInput(torque ? "Formula.function" : "Formula.potential",
                       torque ? "callable as function(t, omega, attitude, p)" : "callable as potential(t, attitude, p)",
                       std::string(py::str(py::type::of(called))), torque ? "a text is given as text=" : "");
  }
  const py::module_ trace = py::module_::import("polhode._formula.trace");
  const py::dict numbers = from_inputs(inputs), starts = from_inputs(to_inputs(own, "Formula.states."));
  const bool is_potential = !potential.is_none();
  Formula made(trace.attr("trace")(called, numbers, starts, is_potential).cast<const Text&>(), may);
  trace.attr("compare")(called, numbers, starts, is_potential, py::cast(made));
  return made;
}

py::tuple get_state(const Formula& formula) {
  const Text& text = formula.text();
  py::tuple state = py::make_tuple(text.torque, to_text_pairs(text.let), to_pairs(text.parameters), formula.recognise(),
                                   to_pairs(text.states), py::tuple(py::cast(text.rates)), text.potential);
  if (text.orbits.empty()) return state;
  return state + py::make_tuple(py::tuple(from_orbits(text).attr("items")()));
}

Formula from_state_of(const py::tuple& s) {
  Text text;
  text.torque = s[0].cast<std::string>();
  text.let = from_text_pairs(s[1]);
  text.parameters = from_pairs(s[2]);
  text.states = from_pairs(s[4]);
  for (const py::handle rate : s[5].cast<py::sequence>()) text.rates.push_back(rate.cast<std::string>());
  text.potential = s[6].cast<std::string>();
  if (s.size() > 7) text.orbits = to_orbits(py::dict(s[7]));
  return Formula(text, s[3].cast<bool>());
}

py::dict from_states(const Formula& formula) {
  const Text& text = formula.text();
  const py::dict starts = from_inputs(text.states);
  py::dict all;
  for (std::size_t i = 0; i < text.states.size(); ++i) {
    const py::str name(text.states[i].name);
    py::dict one;
    one["start"] = starts[name];
    one["rate"] = text.rates[i];
    all[name] = one;
  }
  return all;
}

std::string show(const Formula& formula) {
  const Text& text = formula.text();
  const bool is_potential = !text.potential.empty();
  std::string shown = std::string("polhode.torques.Formula(") + (is_potential ? "potential=" : "text=") +
                      std::string(py::repr(py::str(is_potential ? text.potential : text.torque)));
  if (!text.let.empty()) shown += ", let=" + std::string(py::repr(from_let(text.let)));
  if (!text.states.empty()) shown += ", states=" + std::string(py::repr(from_states(formula)));
  if (!text.orbits.empty()) shown += ", orbits=" + std::string(py::repr(from_orbits(text)));
  if (!formula.recognise()) shown += ", recognise=False";
  for (const auto& [name, value] : from_inputs(formula.parameters()))
    shown += ", " + std::string(py::str(name)) + "=" + std::string(py::repr(value));
  return shown + ")";
}

constexpr const char* formula_doc =
    "Formula(function=None, *, text=None, let=None, potential=None, states=None, orbits=None, recognise=True, "
    R"doc(**parameters)

A torque of your own as a formula: traced once from a Python function, or written as text.

The function is called when the torque is made, on symbols. No Python runs while a motion is computed. A formula that is
a torque of this module (a constant, damping, gravity) is replaced by it when it is solved.

Parameters
----------
function : callable, optional
    ``function(t, omega, attitude, p)`` returns the torque in body axes, shape (3,) [N m]. omega is in body axes, shape
    (3,) [rad/s]. attitude is the unit quaternion (x, y, z, w), shape (4,). ``p.kd`` is the parameter kd. The function
    uses NumPy and `polhode.formula`.
text : str, optional
    The same as text: ``"-kp * attitude.xyz * attitude.w - kd * omega"``. It is given in place of a function.
let : dict of str, optional
    Names for shared parts of a text, in order.
potential : callable or str, optional
    ``potential(t, attitude, p)`` returns V [J], or its text. The torque is its negative gradient on the rotations. It
    is given in place of a torque.
states : dict, optional
    States of the torque's own, by name. Beside a function each has its start, a number or shape (n,). The function is
    then ``function(t, omega, attitude, p, s)`` and returns (torque, rates), a dict of the same names. Beside a text each
    is ``{"start": numbers, "rate": text}``.
orbits : dict of Orbit, optional
    Orbits of a text by name: an orbit ``main`` gives ``main.r``, ``main.v`` [m, m/s], ``main.distance`` and
    ``main.inverse_distance``. A function calls ``orbit.at(t)`` instead.
recognise : bool
    Whether the formula may be replaced by torques of this module.
**parameters : float or array_like, shape (n,)
    Named numbers of the formula.

Raises
------
InvalidInput
    For a text that is no formula. For a function that cannot be traced: the message names the line and what to write
    instead. For a function whose numbers are not those of its formula. For a torque of another shape than (3,).

See Also
--------
polhode.torques.Custom : a function that cannot be traced.
)doc";

constexpr const char* rates_doc = "Return the rates of the torque's own states.\n\n" POLHODE_STATE_DOC R"doc(states : dict, optional
    Numbers of the states by name; the starts if left out.

Returns
-------
dict
    A number, or a tuple of numbers, by name.
)doc";

constexpr const char* energy_doc = R"doc(Return the potential energy of a formula made from a potential; 0 without one.

Parameters
----------
t : float
    Time [s].
attitude : array_like, shape (4,)
    Unit quaternion (x, y, z, w).

Returns
-------
float
    V [J].
)doc";

/// The docstring of a copy with other numbers of some "parameters" or "states".
std::string with_doc(const std::string& numbers, const std::string& what) {
  return "Return the formula with other " + what + " of some of its " + numbers + ".\n\nParameters\n----------\n**" +
         numbers + " : float or array_like, shape (n,)\n    Numbers by the names of its " + numbers +
         ", of the same shapes.\n\nReturns\n-------\nFormula\n\nRaises\n------\nInvalidInput\n"
         "    For a name that it does not have, or another shape.\n";
}

/// The numbers of inputs, some of them replaced by name.
std::vector<double> replace(const std::vector<Input>& inputs, const py::kwargs& numbers, const std::string& prefix) {
  std::vector<double> values = formula::list_values(inputs);
  for (const Input& given : to_inputs(numbers, prefix)) {
    const formula::Place place = formula::find_place(inputs, given.name);
    const std::string where = prefix + given.name;
    if (place.first < 0) {
      std::string known;
      for (const Input& one : inputs) known += (known.empty() ? "" : ", ") + one.name;
      throw InvalidInput(where, "a name that the formula has", known.empty() ? "a formula without any" : known);
    }
    if (std::ssize(given.values) != place.count)
      throw InvalidInput(where, std::to_string(place.count) + (place.count == 1 ? " number" : " numbers"),
                         std::to_string(given.values.size()));
    std::copy(given.values.begin(), given.values.end(), values.begin() + place.first);
  }
  return values;
}

}  // namespace

void bind_torque_formula(py::module_& m) {
  py::class_<Formula> type(m, "Formula", formula_doc);
  type.def(py::init(&make_formula), py::arg("function") = py::none(), py::kw_only(), py::arg("text") = py::none(),
           py::arg("let") = py::none(), py::arg("potential") = py::none(), py::arg("states") = py::none(),
           py::arg("orbits") = py::none(), py::arg("recognise") = true);
  type.def_property_readonly("text", [](const Formula& formula) { return formula.text().torque; },
                             "str: the formula as text; empty for a potential.");
  type.def_property_readonly("potential", [](const Formula& formula) -> py::object {
    if (formula.text().potential.empty()) return py::none();
    return py::str(formula.text().potential);
  }, "str or None: the potential as text.");
  type.def_property_readonly("states", &from_states, "dict: of each state its start, and its rate as text.");
  type.def_property_readonly("orbits", [](const Formula& formula) { return from_orbits(formula.text()); },
                             "dict: the orbits of the text by name.");
  type.def_property_readonly("let", [](const Formula& formula) { return from_let(formula.text().let); },
                             "dict: names for shared parts of the text.");
  type.def_property_readonly("parameters", [](const Formula& formula) { return from_inputs(formula.parameters()); },
                             "dict: the named numbers, sorted by name.");
  type.def("with_parameters", [](const Formula& formula, const py::kwargs& numbers) {
    return formula.with_parameters(replace(formula.parameters(), numbers, "with_parameters."));
  }, with_doc("parameters", "numbers").c_str());
  type.def("with_starts", [](const Formula& formula, const py::kwargs& numbers) {
    return formula.with_starts(replace(formula.states(), numbers, "with_starts."));
  }, with_doc("states", "starts").c_str());
  type.def_property_readonly("recognise", &Formula::recognise, "bool: whether it may be replaced.");
  bind_traits(type);
  bind_value(type);
  type.def("rates", [](const Formula& formula, const py::object& t, const py::object& omega, const py::object& attitude,
                       const py::object& states) {
    const Vector3d w = to_vector3(omega, "omega");
    const Quat unit = to_attitude(attitude, "attitude");
    const double q[4] = {unit.x, unit.y, unit.z, unit.w};
    const std::vector<double> outputs =
        formula.compute({to_real(t, "t"), w.data(), q, Matrix3d::Identity()}, to_state_numbers(formula.states(), states));
    std::vector<Input> rates = formula.states();
    std::size_t next = 3;
    for (Input& rate : rates)
      for (double& value : rate.values) value = outputs[next++];
    return from_inputs(rates);
  }, py::arg("t"), py::arg("omega"), py::arg("attitude"), py::arg("states") = py::none(), rates_doc);
  type.def("energy", [](const Formula& formula, const py::object& t, const py::object& attitude) {
    const Quat unit = to_attitude(attitude, "attitude");
    const double q[4] = {unit.x, unit.y, unit.z, unit.w}, none[3] = {};
    return formula.compute_potential({to_real(t, "t"), none, q, Matrix3d::Identity()});
  }, py::arg("t"), py::arg("attitude"), energy_doc);
  type.def("__repr__", &show);
  type.def("__eq__", [](const Formula& a, const py::object& b) {
    return py::isinstance<Formula>(b) && a == b.cast<const Formula&>();
  });
  type.def("__hash__", [](const Formula& formula) { return py::hash(get_state(formula)); });
  type.def(py::pickle(&get_state, [](const py::tuple& state) {
    return from_state("Formula", state, state.size() == 8 ? 8 : 7, &from_state_of);   // 8: with orbits
  }));
}

}  // namespace polhode::python
