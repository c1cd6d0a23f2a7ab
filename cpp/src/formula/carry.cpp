#include "formula/carry.hpp"

#include "polhode/formula/expression.hpp"

namespace polhode::formula {

std::optional<Wave> find_wave(const Graph& graph, int node) {
  if (graph[node].op == Op::time) return Wave{0.0, 1.0, false};
  if (graph[node].op != Op::linear) return std::nullopt;
  const Form& form = graph.linear(node);
  if (form.terms.size() != 1 || graph[form.terms[0].node].op != Op::time) return std::nullopt;
  return Wave{form.constant, form.terms[0].factor, false};
}

std::optional<std::vector<CarriedVector>> find_carried(const Graph& graph, const std::array<int, 3>& components) {
  std::vector<CarriedVector> found;
  const auto vector_of = [&](double phase, double rate) -> CarriedVector& {
    for (CarriedVector& known : found)
      if (known.phase == phase && known.rate == rate) return known;
    found.push_back({Vector3d::Zero(), Vector3d::Zero(), phase, rate});
    return found.back();
  };
  for (int i = 0; i < 3; ++i) {
    const int node = components[static_cast<std::size_t>(i)];
    const Node& n = graph[node];
    const Form form = n.op == Op::linear     ? graph.linear(node)
                      : n.op == Op::constant ? Form(n.constant)
                                             : Form::of(node);
    if (form.constant != 0.0) vector_of(0.0, 0.0).cosine[i] += form.constant;
    for (const Term& term : form.terms) {
      const Node& part = graph[term.node];
      if (part.op != Op::sine && part.op != Op::cosine) return std::nullopt;
      const std::optional<Wave> wave = find_wave(graph, part.operands[0]);
      if (!wave) return std::nullopt;
      CarriedVector& vector = vector_of(wave->phase, wave->rate);
      (part.op == Op::sine ? vector.sine : vector.cosine)[i] += term.factor;
    }
  }
  return found;
}

Program expand_rotations(const Program& program, bool but_carried) {
  Program made{{}, program.parameters, program.states, {}};
  Rewriter* own = nullptr;
  const Change change = [&](int node, Graph& to) -> std::optional<Form> {
    const Node& n = program.graph[node];
    if (n.op != Op::to_body || (but_carried && find_carried(program.graph, n.operands))) return std::nullopt;
    Vec<Expr, 3> v;
    for (std::size_t i = 0; i < 3; ++i) v[i] = Expr(to, (*own)(Form::of(n.operands[i])));
    return rotate_to_body(list_states<4>(to, first_attitude), v)[static_cast<std::size_t>(n.index)].form();
  };
  Rewriter rewriter(program.graph, made.graph, change);
  own = &rewriter;
  for (const Form& output : program.outputs) made.outputs.push_back(rewriter(output));
  for (const Form& rate : program.rates) made.rates.push_back(rewriter(rate));
  return rewrite(made);
}

}  // namespace polhode::formula
