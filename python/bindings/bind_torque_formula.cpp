#include <algorithm>
#include <memory>
#include <optional>

#include "bind_torque.hpp"
#include "convert.hpp"
#include "polhode/core/error.hpp"
#include "polhode/torque/formula.hpp"

// polhode.torques.Formula, and the symbols that a Python function is traced with (python/polhode/_formula).
namespace polhode::python {
namespace {

using formula::Condition;
using formula::Expr;
using formula::Graph;
using formula::Input;
using formula::Text;
using formula::Vec;
using torques::Formula;

/// A number under construction that keeps its graph alive.
struct Traced {
  std::shared_ptr<Graph> graph;
  Expr expr;
};

struct TracedCondition {
  std::shared_ptr<Graph> graph;
  Condition condition;
};

/// What the arguments of one operation have in common.
class Operands {
 public:
  Expr operator()(py::handle value) {
    if (!py::isinstance<Traced>(value)) return Expr(to_real(value, "a number of the formula"));
    const Traced& traced = value.cast<const Traced&>();
    if (!traced.graph) return traced.expr;   // an operation on numbers alone
    if (graph_ && graph_ != traced.graph) throw InvalidInput("Formula", "of the symbols of one trace", "those of two");
    graph_ = traced.graph;
    return traced.expr;
  }
  Traced wrap(Expr expr) const { return {graph_, std::move(expr)}; }
  std::shared_ptr<Graph> graph_;
};

/// The inputs of one trace. Parameters have one number or several.
struct Tracer {
  explicit Tracer(std::vector<Input> given) : parameters(std::move(given)) {}

  py::list list(int first, int count, formula::Form (Graph::*make)(int)) {
    py::list found;
    for (int i = 0; i < count; ++i) found.append(Traced{graph, Expr(*graph, (graph.get()->*make)(first + i))});
    return found;
  }

  Text finish(const py::sequence& outputs) {
    formula::Program program;
    Operands operands;
    for (const py::handle output : outputs) program.outputs.push_back(operands(output).form());
    if (operands.graph_ && operands.graph_ != graph)
      throw InvalidInput("Formula", "a result of its own symbols", "symbols of another trace");
    program.graph = *graph, program.parameters = parameters;
    return formula::print(formula::rewrite(program));
  }

  std::vector<Input> parameters;
  std::shared_ptr<Graph> graph = std::make_shared<Graph>();
};

/// Parameters by their names: a number, or several.
std::vector<Input> to_inputs(const py::dict& parameters) {
  std::vector<Input> inputs;
  for (const auto& [key, value] : parameters) {
    const std::string name = key.cast<std::string>(), where = "Formula." + name;
    const Array array = to_array(value, where.c_str());
    require_finite(array, where.c_str());
    if (array.ndim() > 1 || (array.ndim() == 1 && array.size() < 2)) {
      throw InvalidInput(where, "a number, or a list of two numbers or more",
                         "shape " + std::string(py::str(array.attr("shape"))), "give a matrix by its rows");
    }
    inputs.push_back({name, {array.data(), array.data() + array.size()}});
  }
  std::sort(inputs.begin(), inputs.end(), [](const Input& a, const Input& b) { return a.name < b.name; });
  return inputs;
}

py::dict from_inputs(const std::vector<Input>& inputs) {
  py::dict dict;
  for (const Input& input : inputs) {
    py::object value = py::float_(input.values[0]);
    if (input.values.size() > 1) value = py::tuple(py::cast(input.values));
    dict[py::str(input.name)] = value;
  }
  return dict;
}

std::string to_field(py::handle value, const std::string& where) {
  if (!py::isinstance<py::str>(value)) throw InvalidInput(where, "text", std::string(py::str(py::type::of(value))));
  if (PyUnicode_AsUTF8(value.ptr()) == nullptr) {
    PyErr_Clear();
    throw InvalidInput(where, "text that UTF-8 can write", std::string(py::str(py::repr(value))));
  }
  return value.cast<std::string>();
}

std::vector<std::pair<std::string, std::string>> to_let(py::handle let) {
  std::vector<std::pair<std::string, std::string>> found;
  if (let.is_none()) return found;
  if (!py::isinstance<py::dict>(let))
    throw InvalidInput("Formula.let", "a dict of names and texts", std::string(py::str(py::type::of(let))));
  for (const auto& [name, text] : py::reinterpret_borrow<py::dict>(let))
    found.emplace_back(to_field(name, "Formula.let"), to_field(text, "Formula.let"));
  return found;
}

py::dict from_let(const Text& text) {
  py::dict dict;
  for (const auto& [name, shared] : text.let) dict[py::str(name)] = shared;
  return dict;
}

bool to_choice(py::handle value) {
  if (!py::isinstance<py::bool_>(value))
    throw InvalidInput("Formula.recognise", "True or False", std::string(py::repr(value)));
  return value.cast<bool>();
}

Formula make_formula(const py::object& function, const py::object& text, const py::object& let,
                     const py::object& recognise, const py::kwargs& parameters) {
  const bool may = to_choice(recognise);
  if (parameters.contains("states")) {
    throw InvalidInput("Formula.states", "left out", "it",
                       "states of a formula are not supported yet; keep them in the function of a Custom torque");
  }
  if (function.is_none() == text.is_none())
    throw InvalidInput("Formula", "given a function or text=, one of them", function.is_none() ? "neither" : "both");
  const std::vector<Input> inputs = to_inputs(parameters);
  if (!text.is_none()) return Formula(Text{to_field(text, "Formula.text"), inputs, {}, {}, to_let(let)}, may);
  if (!let.is_none()) throw InvalidInput("Formula.let", "left out for a function", std::string(py::repr(let)));
  if (!PyCallable_Check(function.ptr())) {
    throw InvalidInput("Formula.function", "callable as function(t, omega, attitude, p)",
                       std::string(py::str(py::type::of(function))), "a text is given as text=");
  }
  const py::module_ trace = py::module_::import("polhode._formula.trace");
  const py::dict given = from_inputs(inputs);
  Formula made(trace.attr("trace")(function, given).cast<const Text&>(), may);
  trace.attr("compare")(function, given, py::cast(made));
  return made;
}

py::tuple get_state(const Formula& formula) {
  const Text& text = formula.text();
  py::list let, parameters;
  for (const auto& [name, shared] : text.let) let.append(py::make_tuple(name, shared));
  for (const Input& input : text.parameters)
    parameters.append(py::make_tuple(input.name, py::tuple(py::cast(input.values))));
  return py::make_tuple(text.torque, py::tuple(let), py::tuple(parameters), formula.recognise());
}

Formula from_state_of(const py::tuple& s) {
  Text text;
  text.torque = s[0].cast<std::string>();
  for (const py::handle one : s[1].cast<py::sequence>()) {
    const py::sequence pair = one.cast<py::sequence>();
    text.let.emplace_back(pair[0].cast<std::string>(), pair[1].cast<std::string>());
  }
  for (const py::handle one : s[2].cast<py::sequence>()) {
    const py::sequence pair = one.cast<py::sequence>();
    Input input{pair[0].cast<std::string>(), {}};
    for (const py::handle value : pair[1].cast<py::sequence>()) input.values.push_back(value.cast<double>());
    text.parameters.push_back(std::move(input));
  }
  return Formula(text, s[3].cast<bool>());
}

std::string show(const Formula& formula) {
  std::string text = "polhode.torques.Formula(text=" + std::string(py::repr(py::str(formula.text().torque)));
  if (!formula.text().let.empty()) text += ", let=" + std::string(py::repr(from_let(formula.text())));
  if (!formula.recognise()) text += ", recognise=False";
  for (const auto& [name, value] : from_inputs(formula.parameters()))
    text += ", " + std::string(py::str(name)) + "=" + std::string(py::repr(value));
  return text + ")";
}

constexpr const char* formula_doc =
    R"doc(Formula(function=None, *, text=None, let=None, recognise=True, **parameters)

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

template <class Function>
void bind_function(py::module_& m, const char* name, Function function) {
  m.def(name, [function](const py::object& a) {
    Operands operands;
    const Expr expr = function(operands(a));
    return operands.wrap(expr);
  });
}

template <class Function>
void bind_operator(py::module_& m, const char* name, Function function) {
  m.def(name, [function](const py::object& a, const py::object& b) {
    Operands operands;
    const Expr left = operands(a), right = operands(b);
    return operands.wrap(function(left, right));
  });
}

void bind_symbols(py::module_& m) {
  py::class_<Text>(m, "Text").def("__eq__", [](const Text& a, const py::object& b) {
    return py::isinstance<Text>(b) && a == b.cast<const Text&>();
  }).def("__hash__", [](const Text& text) { return py::hash(py::str(text.torque)); });
  py::class_<Traced>(m, "Number").def_property_readonly("constant", [](const Traced& traced) -> py::object {
    if (!traced.expr.form().is_constant()) return py::none();
    return py::float_(traced.expr.form().constant);
  });
  py::class_<TracedCondition>(m, "Condition");
  py::class_<Tracer>(m, "Tracer")
      .def(py::init([](const py::dict& parameters) { return Tracer(to_inputs(parameters)); }), py::arg("parameters"))
      .def("time", [](Tracer& t) { return Traced{t.graph, Expr(*t.graph, t.graph->time())}; })
      .def("omega", [](Tracer& t) { return t.list(formula::first_rate, 3, &Graph::state); })
      .def("attitude", [](Tracer& t) { return t.list(formula::first_attitude, 4, &Graph::state); })
      .def("parameters",
           [](Tracer& t) {
             py::dict found;
             int first = 0;
             for (const Input& input : t.parameters) {
               const int count = static_cast<int>(input.values.size());
               const py::list numbers = t.list(first, count, &Graph::parameter);
               found[py::str(input.name)] = count == 1 ? py::object(numbers[0]) : py::object(numbers);
               first += count;
             }
             return found;
           })
      .def("finish", &Tracer::finish, py::arg("outputs"));
  bind_operator(m, "add", [](const Expr& a, const Expr& b) { return a + b; });
  bind_operator(m, "subtract", [](const Expr& a, const Expr& b) { return a - b; });
  bind_operator(m, "multiply", [](const Expr& a, const Expr& b) { return a * b; });
  bind_operator(m, "divide", [](const Expr& a, const Expr& b) { return a / b; });
  bind_operator(m, "arctan2", [](const Expr& a, const Expr& b) { return formula::atan2(a, b); });
  bind_operator(m, "minimum", [](const Expr& a, const Expr& b) { return formula::min(a, b); });
  bind_operator(m, "maximum", [](const Expr& a, const Expr& b) { return formula::max(a, b); });
  bind_function(m, "sqrt", [](const Expr& a) { return formula::sqrt(a); });
  bind_function(m, "exp", [](const Expr& a) { return formula::exp(a); });
  bind_function(m, "log", [](const Expr& a) { return formula::log(a); });
  bind_function(m, "sin", [](const Expr& a) { return formula::sin(a); });
  bind_function(m, "cos", [](const Expr& a) { return formula::cos(a); });
  bind_function(m, "tan", [](const Expr& a) { return formula::tan(a); });
  bind_function(m, "tanh", [](const Expr& a) { return formula::tanh(a); });
  bind_function(m, "absolute", [](const Expr& a) { return formula::abs(a); });
  bind_function(m, "sign", [](const Expr& a) { return formula::sign(a); });
  m.def("power", [](const py::object& a, double exponent) {
    Operands operands;
    const Expr expr = formula::pow(operands(a), exponent);
    return operands.wrap(expr);
  });
  m.def("compare", [](const py::object& a, const py::object& b, bool negated) {   // a > b, or not
    Operands operands;
    const Expr left = operands(a), right = operands(b);
    Condition condition = left > right;
    condition.negated = negated;
    return TracedCondition{operands.graph_, condition};
  });
  m.def("where", [](const TracedCondition& condition, const py::object& a, const py::object& b) {
    Operands operands;
    operands.graph_ = condition.graph;
    const Expr yes = operands(a), no = operands(b);
    return operands.wrap(formula::where(condition.condition, yes, no));
  });
  m.def("to_body", [](const py::sequence& attitude, const py::sequence& vector) {
    Operands operands;
    Vec<Expr, 4> q;
    Vec<Expr, 3> v;
    for (std::size_t i = 0; i < 4; ++i) q[i] = operands(attitude[i]);
    for (std::size_t i = 0; i < 3; ++i) v[i] = operands(vector[i]);
    py::list found;
    for (const Expr& component : formula::to_body(q, v).components) found.append(operands.wrap(component));
    return found;
  });
}

}  // namespace

void bind_torque_formula(py::module_& m) {
  py::class_<Formula> type(m, "Formula", formula_doc);
  type.def(py::init(&make_formula), py::arg("function") = py::none(), py::kw_only(), py::arg("text") = py::none(),
           py::arg("let") = py::none(), py::arg("recognise") = true);
  type.def_property_readonly("text", [](const Formula& formula) { return formula.text().torque; },
                             "str: the formula as text.");
  type.def_property_readonly("let", [](const Formula& formula) { return from_let(formula.text()); },
                             "dict: names for shared parts of the text.");
  type.def_property_readonly("parameters", [](const Formula& formula) { return from_inputs(formula.parameters()); },
                             "dict: the named numbers, sorted by name.");
  type.def_property_readonly("recognise", &Formula::recognise, "bool: whether it may be replaced.");
  bind_traits(type);
  bind_value(type);
  type.def("__repr__", &show);
  type.def("__eq__", [](const Formula& a, const py::object& b) {
    return py::isinstance<Formula>(b) && a == b.cast<const Formula&>();
  });
  type.def("__hash__", [](const Formula& formula) { return py::hash(get_state(formula)); });
  type.def(py::pickle(&get_state, [](const py::tuple& state) {
    return from_state("Formula", state, 4, &from_state_of);
  }));
}

void bind_formula_symbols(py::module_& m) {
  py::module_ symbols = m.def_submodule("symbols", "What a traced function computes with.");
  bind_symbols(symbols);
}

}  // namespace polhode::python
