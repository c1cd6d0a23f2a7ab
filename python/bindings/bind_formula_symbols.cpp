#include <algorithm>
#include <memory>

#include "bind_formula.hpp"
#include "bind_orbit.hpp"
#include "polhode/torque/magnetic_field.hpp"
#include "bind_torque.hpp"
#include "convert.hpp"
#include "polhode/core/error.hpp"
#include "polhode/formula/expression.hpp"
#include "polhode/formula/parser.hpp"

// The symbols that a Python function is traced with (python/polhode/_formula).
namespace polhode::python {

using formula::Condition;
using formula::Expr;
using formula::Graph;
using formula::Input;
using formula::Text;
using formula::Vec;

std::vector<Input> to_inputs(const py::dict& parameters, const std::string& prefix) {
  std::vector<Input> inputs;
  for (const auto& [key, value] : parameters) {
    if (!py::isinstance<py::str>(key))
      throw InvalidInput(prefix.substr(0, prefix.size() - 1), "named by texts", std::string(py::repr(key)));
    const std::string name = key.cast<std::string>(), where = prefix + name;
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

namespace {

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
  Tracer(std::vector<Input> given, std::vector<Input> own) : parameters(std::move(given)), states(std::move(own)) {}

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
    program.graph = *graph, program.parameters = parameters, program.states = states;
    return formula::print(formula::rewrite(program));
  }

  /// Inputs by their names, whose numbers are nodes from `first` on.
  py::dict name(const std::vector<Input>& inputs, int first, formula::Form (Graph::*make)(int)) {
    py::dict found;
    for (const Input& input : inputs) {
      const int count = static_cast<int>(input.values.size());
      const py::list numbers = list(first, count, make);
      found[py::str(input.name)] = count == 1 ? py::object(numbers[0]) : py::object(numbers);
      first += count;
    }
    return found;
  }

  std::vector<Input> parameters, states;
  std::shared_ptr<Graph> graph = std::make_shared<Graph>();
};

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
  m.def("split_text", [](const Text& text) {   // (shared parts, new numbers of each state)
    py::dict rates;
    for (std::size_t i = 0; i < text.states.size(); ++i) rates[py::str(text.states[i].name)] = text.rates[i];
    return py::make_tuple(from_let(text.let), rates);
  });
  py::class_<Traced>(m, "Number").def_property_readonly("constant", [](const Traced& traced) -> py::object {
    if (!traced.expr.form().is_constant()) return py::none();
    return py::float_(traced.expr.form().constant);
  });
  py::class_<TracedCondition>(m, "Condition");
  py::class_<Tracer>(m, "Tracer")
      .def(py::init([](const py::dict& parameters, const py::dict& states) {
             return Tracer(to_inputs(parameters), to_inputs(states, "Formula.states."));
           }),
           py::arg("parameters"), py::arg("states") = py::dict())
      .def("time", [](Tracer& t) { return Traced{t.graph, Expr(*t.graph, t.graph->time())}; })
      .def("omega", [](Tracer& t) { return t.list(formula::first_rate, 3, &Graph::state); })
      .def("attitude", [](Tracer& t) { return t.list(formula::first_attitude, 4, &Graph::state); })
      .def("parameters", [](Tracer& t) { return t.name(t.parameters, 0, &Graph::parameter); })
      .def("states", [](Tracer& t) { return t.name(t.states, formula::first_extra, &Graph::state); })
      .def("finish", &Tracer::finish, py::arg("outputs"));
  bind_operator(m, "add", [](const Expr& a, const Expr& b) { return a + b; });
  bind_operator(m, "subtract", [](const Expr& a, const Expr& b) { return a - b; });
  bind_operator(m, "multiply", [](const Expr& a, const Expr& b) { return a * b; });
  bind_operator(m, "divide", [](const Expr& a, const Expr& b) { return a / b; });
  bind_operator(m, "arctan2", [](const Expr& a, const Expr& b) { return formula::atan2(a, b); });
  bind_operator(m, "minimum", [](const Expr& a, const Expr& b) { return formula::min(a, b); });
  bind_operator(m, "maximum", [](const Expr& a, const Expr& b) { return formula::max(a, b); });
  bind_operator(m, "friction", [](const Expr& load, const Expr& rate) { return formula::friction(load, rate); });
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
  m.def("see_orbit", [](const py::object& orbit, const py::object& t) {
    Operands operands;
    const formula::Seen<Expr> seen = formula::see(to_ephemeris(orbit, "orbit"), operands(t));
    py::list r, v;
    for (const Expr& one : seen.r.components) r.append(operands.wrap(one));
    for (const Expr& one : seen.v.components) v.append(operands.wrap(one));
    return py::make_tuple(r, v);
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

py::list see_field(const py::object& own, const py::object& t) {
  const auto& field = own.cast<const MagneticField&>();
  Operands operands;
  py::list found;
  for (const Expr& component : field.see(operands(t)).components) found.append(operands.wrap(component));
  return found;
}

}  // namespace

void bind_formula_symbols(py::module_& m) {
  py::module_ symbols = m.def_submodule("symbols", "What a traced function computes with.");
  bind_symbols(symbols);
  bind_torque_field(m);
  symbols.def("see_field", &see_field);
}

}  // namespace polhode::python
