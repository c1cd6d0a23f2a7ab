#include <algorithm>
#include <map>
#include <string>

#include "polhode/core/error.hpp"
#include "polhode/formula/parser.hpp"

namespace polhode::formula {
namespace {

std::string bracket(std::string text) {
  text.insert(text.begin(), '(');
  return text += ')';
}

class Printer {
 public:
  /// @param inlined  nodes that are used once are written where they are used
  Printer(const Program& program, bool inlined) : program_(program), graph_(program.graph), inlined_(inlined) {
    for (const std::vector<Input>* inputs : {&program.parameters, &program.states})
      for (const Input& input : *inputs)
        while (input.name.size() > prefix_.size() && input.name.starts_with(prefix_)) prefix_ += '_';
    for (const Ephemeris& one : graph_.ephemerides()) orbits_.emplace_back(find_name(one), one);
    for (const auto& [name, one] : orbits_)
      while (name.size() > prefix_.size() && name.starts_with(prefix_)) prefix_ += '_';
  }

  Text print() {
    Text text;
    text.parameters = program_.parameters, text.states = program_.states, text.orbits = orbits_;
    count_uses();
    for (int i = 0; i < graph_.size(); ++i) {
      const Op op = graph_[i].op;
      if (op == Op::constant || op == Op::time || op == Op::state || op == Op::parameter || op == Op::ephemeris) continue;
      if (uses_[i] == 0 || (inlined_ && uses_[i] == 1)) continue;
      text.let.emplace_back(prefix_ + std::to_string(i), operation(i));
    }
    std::size_t output = 0;
    (program_.outputs.size() == 1 ? text.potential : text.torque) = vector(output, program_.outputs.size() == 1 ? 1 : 3);
    for (const Input& state : program_.states) text.rates.push_back(vector(output, state.values.size()));
    return text;
  }

 private:
  /// Its own name, or orbit, orbit1, ...
  std::string find_name(const Ephemeris& one) const {
    const auto is_taken = [&](const std::string& name) {
      const auto same = [&](const auto& other) { return other.first == name; };
      return name.empty() || find_place(program_.parameters, name).count > 0 ||
             find_place(program_.states, name).count > 0 || std::any_of(orbits_.begin(), orbits_.end(), same);
    };
    std::string name = one.name().empty() ? "orbit" : one.name();
    for (int i = 1; is_taken(name); ++i) name = "orbit" + std::to_string(i);
    return name;
  }

  void count_uses() {
    const auto count = [&](const Form& form) {
      for (const Term& term : form.terms) ++uses_[term.node];
    };
    for (const Form& output : program_.outputs) count(output);
    const std::vector<bool> live = find_live(graph_, program_.outputs);
    for (int i = graph_.size() - 1; i >= 0; --i) {
      if (!live[static_cast<std::size_t>(i)]) continue;
      if (graph_[i].op == Op::linear) count(graph_.linear(i));
      for (const int operand : graph_[i].operands)
        if (operand >= 0) ++uses_[operand];
    }
  }

  std::string vector(std::size_t& output, std::size_t count) {
    if (count == 1) return form(program_.outputs[output++]);
    std::string text = "[";
    for (std::size_t i = 0; i < count; ++i) text += (i > 0 ? ", " : "") + form(program_.outputs[output++]);
    return text + "]";
  }

  /// A sum, without brackets around it.
  std::string form(const Form& sum) {
    std::string text = sum.constant != 0.0 || sum.is_constant() ? to_text(sum.constant) : "";
    for (const Term& term : sum.terms) {
      const bool minus = term.factor < 0.0;
      const double size = minus ? -term.factor : term.factor;
      text += text.empty() ? (minus ? "-" : "") : (minus ? " - " : " + ");
      text += (size != 1.0 ? to_text(size) + " * " : "") + atom(term.node);
    }
    return text;
  }

  /// A node as an operand.
  std::string atom(int node) {
    const Node& n = graph_[node];
    switch (n.op) {
      case Op::constant: return n.constant < 0.0 ? bracket(to_text(n.constant)) : to_text(n.constant);
      case Op::time: return "t";
      case Op::parameter: return name(program_.parameters, n.index);
      case Op::ephemeris: {
        static constexpr const char* parts[] = {"r.x", "r.y", "r.z", "v.x", "v.y", "v.z", "distance", "inverse_distance"};
        return orbits_[static_cast<std::size_t>(n.index / Ephemeris::size)].first + "." + parts[n.index % Ephemeris::size];
      }
      case Op::state:
        if (n.index < first_attitude) return std::string("omega.") + "xyz"[n.index];
        if (n.index < first_extra) return std::string("attitude.") + "xyzw"[n.index - first_attitude];
        return name(program_.states, n.index - first_extra);
      default: break;
    }
    return inlined_ && uses_[node] == 1 ? bracket(operation(node)) : prefix_ + std::to_string(node);
  }

  static std::string name(const std::vector<Input>& inputs, int number) {
    for (const Input& input : inputs) {
      const int count = static_cast<int>(input.values.size());
      if (number < count) return count == 1 ? input.name : input.name + "[" + std::to_string(number) + "]";
      number -= count;
    }
    throw InvalidInput("formula", "a name for each input", "an input without one");
  }

  std::string operation(int node) {
    const Node& n = graph_[node];
    const auto operand = [&](std::size_t i) { return atom(n.operands[i]); };
    switch (n.op) {
      case Op::linear: return form(graph_.linear(node));
      case Op::multiply: return operand(0) + " * " + operand(1);
      case Op::divide: return operand(0) + " / " + operand(1);
      case Op::root: return "sqrt(" + operand(0) + ")";
      case Op::power:
        return operand(0) + "^" + (n.constant < 0.0 ? bracket(to_text(n.constant)) : to_text(n.constant));
      case Op::exponential: return "exp(" + operand(0) + ")";
      case Op::logarithm: return "log(" + operand(0) + ")";
      case Op::sine: return "sin(" + operand(0) + ")";
      case Op::cosine: return "cos(" + operand(0) + ")";
      case Op::tanh: return "tanh(" + operand(0) + ")";
      case Op::angle: return "atan2(" + operand(0) + ", " + operand(1) + ")";
      case Op::choose:
        if (n.index == 1) return "friction(-1, " + operand(0) + ")";
        return "where(" + operand(0) + " > 0, " + operand(1) + ", " + operand(2) + ")";
      case Op::to_body:
        return "to_body([" + operand(0) + ", " + operand(1) + ", " + operand(2) + "])." + "xyz"[n.index];
      default: return atom(node);
    }
  }

  const Program& program_;
  const Graph& graph_;
  bool inlined_;
  std::string prefix_ = "n";
  std::vector<std::pair<std::string, Ephemeris>> orbits_;
  std::map<int, int> uses_;
};

}  // namespace

Text print(const Program& given) {
  const Program program = rewrite(given);
  // Where nodes are written decides their order, and so the bits of sums. Where it would differ, each node gets a line.
  Text text = Printer(program, true).print();
  bool same = false;
  try {
    same = is_same(parse(text), program);
  } catch (const InvalidInput&) {
    same = false;   // longer or deeper than a text may be
  }
  return same ? text : Printer(program, false).print();
}

}  // namespace polhode::formula
