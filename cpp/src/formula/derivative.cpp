#include "polhode/formula/derivative.hpp"

#include <algorithm>

#include "polhode/core/error.hpp"
#include "polhode/formula/expression.hpp"
#include "polhode/formula/facts.hpp"

namespace polhode::formula {
namespace {

/// Derivatives of all nodes by one variable.
class Derivative {
 public:
  Derivative(Graph& graph, int nodes, const std::vector<bool>& live, Variable by)
      : graph_(graph), by_(by), forms_(static_cast<std::size_t>(nodes)) {
    for (int i = 0; i < nodes; ++i)
      if (live[static_cast<std::size_t>(i)]) forms_[static_cast<std::size_t>(i)] = make(i);
  }

  Form operator()(const Form& form) const {
    Form sum;
    for (const Term& term : form.terms) sum = sum + forms_[static_cast<std::size_t>(term.node)] * term.factor;
    return sum;
  }

 private:
  Form make(int node) {
    const Node n = graph_[node];   // a copy: new nodes move the old ones
    switch (n.op) {
      case Op::constant: return {};
      case Op::time: return by_.kind == Variable::Kind::time ? Form(1.0) : Form();
      case Op::ephemeris: return by_.kind == Variable::Kind::time ? of_ephemeris(n) : Form();
      case Op::state: return of_state(n.index);
      case Op::parameter: return by_.kind == Variable::Kind::parameter && by_.number == n.index ? Form(1.0) : Form();
      case Op::linear: return (*this)(Form(graph_.linear(node)));
      case Op::to_body: return of_rotation(n);
      case Op::choose:
        return graph_.choose(Form::of(n.operands[0]), of(n.operands[1]), of(n.operands[2]));
      default: return chain(n, Form::of(node));
    }
  }

  const Form& of(int node) const { return forms_[static_cast<std::size_t>(node)]; }

  /// dq/da = q (e, 0) / 2
  Form of_state(int number) {
    if (by_.kind == Variable::Kind::state) return by_.number == number ? Form(1.0) : Form();
    if (by_.kind != Variable::Kind::rotation || number < first_attitude || number >= first_extra) return {};
    Vec<Expr, 3> axis;
    axis[static_cast<std::size_t>(by_.number)] = Expr(1.0);
    const Vec<Expr, 4> rotation = multiply_pure(list_states<4>(graph_, first_attitude), axis);
    return rotation[static_cast<std::size_t>(number - first_attitude)].form() * 0.5;
  }

  /// r' = v, |r|' = r.v / |r|
  Form of_ephemeris(const Node& n) {
    const Ephemeris seen = graph_.ephemeris_of(n);   // a copy: new ones move the old ones
    const auto get = [&](int number) { return graph_.ephemeris(seen, number); };
    const int number = n.index % Ephemeris::size;
    if (number < Ephemeris::velocity) return get(Ephemeris::velocity + number);
    if (number < Ephemeris::distance)
      throw InvalidInput("Formula", "without the velocity of an orbit where friction holds", "one with it");
    Form product;
    for (int i = 0; i < 3; ++i)
      product = product + graph_.multiply(get(Ephemeris::position + i), get(Ephemeris::velocity + i));
    const Form inverse = get(Ephemeris::inverse_distance), rate = graph_.multiply(product, inverse);
    return number == Ephemeris::distance ? rate : -graph_.multiply(graph_.multiply(inverse, inverse), rate);
  }

  /// d(R^T v) = (R^T v) x e + R^T dv
  Form of_rotation(const Node& n) {
    const auto at = static_cast<std::size_t>(n.index);
    Form sum = graph_.to_body({of(n.operands[0]), of(n.operands[1]), of(n.operands[2])})[at];
    if (by_.kind != Variable::Kind::rotation) return sum;
    const std::array<Form, 3> seen =
        graph_.to_body({Form::of(n.operands[0]), Form::of(n.operands[1]), Form::of(n.operands[2])});
    const int j = (n.index + 1) % 3, k = (n.index + 2) % 3;
    if (by_.number == k) sum = sum + seen[static_cast<std::size_t>(j)];
    if (by_.number == j) sum = sum - seen[static_cast<std::size_t>(k)];
    return sum;
  }

  Form chain(const Node& n, const Form& z) {
    const Form a = Form::of(n.operands[0]), da = of(n.operands[0]);
    const Form b = n.operands[1] >= 0 ? Form::of(n.operands[1]) : Form();
    const Form db = n.operands[1] >= 0 ? of(n.operands[1]) : Form();
    if (da.is_zero() && db.is_zero()) return {};
    switch (n.op) {
      case Op::multiply: return graph_.multiply(da, b) + graph_.multiply(a, db);
      case Op::divide: return graph_.divide(da - graph_.multiply(z, db), b);
      case Op::root: return graph_.divide(da * 0.5, z);
      case Op::power: return graph_.multiply(graph_.divide(z, a) * n.constant, da);
      case Op::exponential: return graph_.multiply(z, da);
      case Op::logarithm: return graph_.divide(da, a);
      case Op::sine: return graph_.multiply(graph_.cosine(a), da);
      case Op::cosine: return -graph_.multiply(graph_.sine(a), da);
      case Op::tanh: return graph_.multiply(Form(1.0) - graph_.multiply(z, z), da);
      default: {   // atan2(a, b)
        const Form squares = graph_.multiply(a, a) + graph_.multiply(b, b);
        return graph_.divide(graph_.multiply(b, da) - graph_.multiply(a, db), squares);
      }
    }
  }

  Graph& graph_;
  Variable by_;
  std::vector<Form> forms_;
};

}  // namespace

Program differentiate(const Program& program, const std::vector<Variable>& variables) {
  const bool by_attitude = std::any_of(variables.begin(), variables.end(), [](const Variable& v) {
    return v.kind == Variable::Kind::state && v.number >= first_attitude && v.number < first_extra;
  });
  Program made = by_attitude ? expand_rotations(program) : rewrite(program);
  const std::vector<Form> outputs = made.outputs;
  const std::vector<bool> live = find_live(made.graph, outputs);
  const int nodes = made.graph.size();
  for (const Variable& variable : variables) {
    const Derivative derivative(made.graph, nodes, live, variable);
    for (const Form& output : outputs) made.outputs.push_back(derivative(output));
  }
  return rewrite(made);
}

Program derive_torque(const Program& potential) {
  if (find_facts(potential).uses_rates)
    throw InvalidInput("Formula.potential", "a function of time and attitude", "one of omega");
  Program made = differentiate(potential, {{Variable::Kind::rotation, 0}, {Variable::Kind::rotation, 1},
                                           {Variable::Kind::rotation, 2}});
  made.outputs.erase(made.outputs.begin());
  for (Form& output : made.outputs) output = -output;
  return rewrite(made);
}

}  // namespace polhode::formula
