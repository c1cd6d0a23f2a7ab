#include "polhode/formula/program.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <utility>

#include "polhode/core/error.hpp"
#include "polhode/formula/expression.hpp"

namespace polhode::formula {

Place find_place(const std::vector<Input>& inputs, std::string_view name) {
  int first = 0;
  for (const Input& input : inputs) {
    const int count = static_cast<int>(input.values.size());
    if (input.name == name) return {first, count};
    first += count;
  }
  return {-1, 0};
}

std::vector<double> list_values(const std::vector<Input>& inputs) {
  std::vector<double> all;
  for (const Input& input : inputs) all.insert(all.end(), input.values.begin(), input.values.end());
  return all;
}

Rewriter::Rewriter(const Graph& from, Graph& to, Change change)
    : from_(from), to_(to), change_(std::move(change)), made_(static_cast<std::size_t>(from.size())) {}

Form Rewriter::operator()(const Form& form) {
  Form sum(form.constant);
  for (const Term& term : form.terms) sum = sum + copy(term.node) * term.factor;
  return sum;
}

const Form& Rewriter::copy(int node) {
  // Operands precede their node, so one pass over the nodes that are needed makes them in their old order.
  std::vector<int> open{node};
  while (!open.empty()) {
    const int top = open.back();
    auto& made = made_[static_cast<std::size_t>(top)];
    const std::size_t before = open.size();
    if (!made) {
      const Node& n = from_[top];
      for (const int operand : n.operands)
        if (operand >= 0 && !made_[static_cast<std::size_t>(operand)]) open.push_back(operand);
      if (n.op == Op::linear)
        for (const Term& term : from_.linear(top).terms)
          if (!made_[static_cast<std::size_t>(term.node)]) open.push_back(term.node);
      if (open.size() == before) made = make(top);
    }
    if (open.size() == before) open.pop_back();
  }
  return *made_[static_cast<std::size_t>(node)];
}

Form Rewriter::make(int node) {
  if (change_)
    if (std::optional<Form> changed = change_(node, to_)) return *std::move(changed);
  const Node& n = from_[node];
  const auto operand = [&](std::size_t i) -> const Form& {
    return *made_[static_cast<std::size_t>(n.operands[i])];
  };
  switch (n.op) {
    case Op::constant: return n.constant;
    case Op::time: return to_.time();
    case Op::state: return to_.state(n.index);
    case Op::parameter: return to_.parameter(n.index);
    case Op::ephemeris: return to_.ephemeris(from_.ephemeris_of(n), n.index % Ephemeris::size);
    case Op::linear: {
      const Form& old = from_.linear(node);
      Form sum(old.constant);
      for (const Term& term : old.terms) sum = sum + *made_[static_cast<std::size_t>(term.node)] * term.factor;
      return sum;
    }
    case Op::multiply: return to_.multiply(operand(0), operand(1));
    case Op::divide: return to_.divide(operand(0), operand(1));
    case Op::root: return to_.root(operand(0));
    case Op::power: return to_.power(operand(0), n.constant);
    case Op::exponential: return to_.exponential(operand(0));
    case Op::logarithm: return to_.logarithm(operand(0));
    case Op::sine: return to_.sine(operand(0));
    case Op::cosine: return to_.cosine(operand(0));
    case Op::tanh: return to_.tanh(operand(0));
    case Op::angle: return to_.angle(operand(0), operand(1));
    case Op::choose:
      if (n.index == 1) return to_.slip(operand(0));
      return to_.choose(operand(0), operand(1), operand(2));
    case Op::to_body: return to_.to_body({operand(0), operand(1), operand(2)})[static_cast<std::size_t>(n.index)];
  }
  return {};
}

std::vector<bool> find_live(const Graph& graph, const std::vector<Form>& forms,
                            const std::function<bool(int node)>& is_leaf) {
  std::vector<bool> live(static_cast<std::size_t>(graph.size()));
  const auto mark = [&](const Form& form) {
    for (const Term& term : form.terms) live[static_cast<std::size_t>(term.node)] = true;
  };
  for (const Form& form : forms) mark(form);
  bool rotates = false;
  for (int i = graph.size() - 1; i >= 0; --i) {
    if (!live[static_cast<std::size_t>(i)] || (is_leaf && is_leaf(i))) continue;
    const Node& node = graph[i];
    if (node.op == Op::linear) mark(graph.linear(i));
    for (const int operand : node.operands)
      if (operand >= 0) live[static_cast<std::size_t>(operand)] = true;
    rotates = rotates || node.op == Op::to_body;
  }
  for (int i = 0; rotates && i < graph.size(); ++i) {
    const Node& node = graph[i];
    if (node.op == Op::state && node.index >= first_attitude && node.index < first_extra)
      live[static_cast<std::size_t>(i)] = true;
  }
  return live;
}

bool is_same(const Program& a, const Program& b) {
  if (a.graph.size() != b.graph.size() || a.outputs != b.outputs || a.parameters != b.parameters ||
      a.states != b.states || a.graph.ephemerides() != b.graph.ephemerides())
    return false;
  for (int i = 0; i < a.graph.size(); ++i) {
    const bool linear = a.graph[i].op == Op::linear && b.graph[i].op == Op::linear;
    if (linear ? a.graph.linear(i) != b.graph.linear(i) : a.graph[i] != b.graph[i]) return false;
  }
  return true;
}

Program rewrite(const Program& program, const Change& change) {
  Program made{{}, program.parameters, program.states, {}};
  Rewriter rewriter(program.graph, made.graph, change);
  std::vector<Form> needed = program.outputs;
  needed.insert(needed.end(), program.rates.begin(), program.rates.end());
  const std::vector<bool> live = find_live(program.graph, needed);
  // An order that does not depend on which input was named first, because the order of terms decides bits.
  std::vector<std::array<int, 3>> inputs;   // kind, number, node
  for (int i = 0; i < program.graph.size(); ++i) {
    const Node& n = program.graph[i];
    const bool is_input = n.op == Op::time || n.op == Op::state || n.op == Op::parameter || n.op == Op::ephemeris;
    if (live[static_cast<std::size_t>(i)] && is_input)
      inputs.push_back({static_cast<int>(n.op), n.index, i});
  }
  std::sort(inputs.begin(), inputs.end());
  for (const auto& input : inputs) rewriter(Form::of(input[2]));
  for (int i = 0; i < program.graph.size(); ++i)
    if (live[static_cast<std::size_t>(i)]) rewriter(Form::of(i));
  for (const Form& output : program.outputs) {
    made.outputs.push_back(rewriter(output));
    require_finite(made.outputs.back());
  }
  for (const Form& rate : program.rates) made.rates.push_back(rewriter(rate));
  return made;
}

std::vector<Form> embed(const Program& program, Graph& to, const std::vector<Form>& states, const Matrix3d* rotation) {
  Rewriter* own = nullptr;
  const Change change = [&](int node, Graph& graph) -> std::optional<Form> {
    const Node& n = program.graph[node];
    if (n.op == Op::state) return states[static_cast<std::size_t>(n.index)];
    if (n.op != Op::to_body || rotation == nullptr) return std::nullopt;
    std::array<Form, 3> v;
    for (std::size_t i = 0; i < 3; ++i) v[i] = (*own)(Form::of(n.operands[i]));
    const std::array<Form, 3> seen = graph.to_body(v);
    Form sum;
    for (int j = 0; j < 3; ++j) sum = sum + seen[static_cast<std::size_t>(j)] * (*rotation)(n.index, j);
    return sum;
  };
  Rewriter rewriter(program.graph, to, change);
  own = &rewriter;
  std::vector<Form> outputs;
  for (const Form& output : program.outputs) outputs.push_back(rewriter(output));
  return outputs;
}

Program bind_parameters(const Program& program, const std::vector<double>& values) {
  if (values.size() != list_values(program.parameters).size()) {
    throw InvalidInput("parameters", std::to_string(list_values(program.parameters).size()) + " numbers",
                       std::to_string(values.size()));
  }
  Program made = rewrite(program, [&](int node, Graph&) -> std::optional<Form> {
    const Node& n = program.graph[node];
    if (n.op != Op::parameter) return std::nullopt;
    return Form(values[static_cast<std::size_t>(n.index)]);
  });
  made.parameters.clear();
  return rewrite(made);
}

Program bind_some(const Program& program, int first, const std::vector<double>& values) {
  const int count = static_cast<int>(values.size());
  Program made = rewrite(program, [&](int node, Graph& graph) -> std::optional<Form> {
    const Node& n = program.graph[node];
    if (n.op != Op::parameter || n.index < first) return std::nullopt;
    if (n.index >= first + count) return graph.parameter(n.index - count);
    return Form(values[static_cast<std::size_t>(n.index - first)]);
  });
  made.parameters.clear();
  int number = 0;
  for (const Input& input : program.parameters) {
    if (number < first || number >= first + count) made.parameters.push_back(input);
    number += static_cast<int>(input.values.size());
  }
  return rewrite(made);
}

bool uses_parameters_from(const Program& program, int first) {
  const std::vector<bool> live = find_live(program.graph, program.outputs);
  for (int i = 0; i < program.graph.size(); ++i)
    if (live[static_cast<std::size_t>(i)] && program.graph[i].op == Op::parameter && program.graph[i].index >= first)
      return true;
  return false;
}

Program make_body_equations(const Program& torque, const Matrix3d& inertia_B) {
  Program made = torque;
  made.outputs.clear();
  Graph& graph = made.graph;
  const Vec<Expr, 3> w = list_states<3>(graph, first_rate);
  const Vec<Expr, 4> q = list_states<4>(graph, first_attitude);
  Vec<Expr, 3> rest;
  const Matrix3d& I = inertia_B;
  const bool diagonal = I(0, 1) == 0.0 && I(0, 2) == 0.0 && I(1, 2) == 0.0;
  Vec<Expr, 3> tau;
  for (std::size_t i = 0; i < 3; ++i) tau[i] = Expr(graph, torque.outputs[i]);
  if (diagonal) {
    // One rounding of each constant: (I_2 - I_3) / I_1.
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      const auto at = [](int n) { return static_cast<std::size_t>(n); };
      rest[at(i)] = tau[at(i)] / I(i, i) + w[at(j)] * w[at(k)] * ((I(j, j) - I(k, k)) / I(i, i));
    }
  } else {
    const Vec<Expr, 3> h = apply_matrix(I, w);
    rest = apply_matrix(I.inverse(), tau - cross(w, h));
  }
  for (const Expr& rate : rest.components) made.outputs.push_back(rate.form());
  const Vec<Expr, 4> rotation = multiply_pure(q, w);
  for (const Expr& rate : rotation.components) made.outputs.push_back((rate * 0.5).form());
  for (std::size_t i = 3; i < torque.outputs.size(); ++i) made.outputs.push_back(torque.outputs[i]);
  return rewrite(made);
}

}  // namespace polhode::formula
