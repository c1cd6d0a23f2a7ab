#include "polhode/formula/tape.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "formula/carry.hpp"
#include "polhode/core/error.hpp"
#include "polhode/formula/expression.hpp"

namespace polhode::formula {

class Tape::Builder {
 public:
  Builder(Tape& tape, const Program& system, int states)
      : tape_(tape), graph_(system.graph), forms_(static_cast<std::size_t>(system.graph.size())) {
    tape_.states_ = states, tape_.ephemerides_ = graph_.ephemerides();
    for (int i = 0; i < states; ++i) add_state({.start = StartKind::given, .number = i});
    const auto is_known = [&](int node) {
      const Node& n = graph_[node];
      return n.op == Op::to_body || ((n.op == Op::sine || n.op == Op::cosine) && find_wave(graph_, n.operands[0]));
    };
    std::vector<Form> needed = system.outputs;
    needed.insert(needed.end(), system.rates.begin(), system.rates.end());
    rates_ = &system.rates;
    const std::vector<bool> live = find_live(graph_, needed, is_known);
    for (int i = 0; i < graph_.size(); ++i)
      if (live[static_cast<std::size_t>(i)]) forms_[static_cast<std::size_t>(i)] = make(i);
    for (std::size_t i = 0; i < system.outputs.size(); ++i) {
      Form form = translate(system.outputs[i]);
      if (i < static_cast<std::size_t>(states)) {
        tape_.state_slots_[i].rate = std::move(form);
      } else {
        tape_.extras_.push_back(std::move(form));
      }
    }
  }

 private:
  int add_slot(SlotKind kind, std::size_t index) {
    tape_.slots_.push_back({kind, static_cast<int>(index)});
    return static_cast<int>(tape_.slots_.size()) - 1;
  }

  int add_state(StateSlot state) {
    state.slot = add_slot(SlotKind::state, tape_.state_slots_.size());
    tape_.state_slots_.push_back(std::move(state));
    return tape_.state_slots_.back().slot;
  }

  int add_operation(Recurrence operation) {
    if (operation.first < 0) operation.first = operation.a;
    if (operation.second < 0) operation.second = operation.first;
    tape_.operations_.push_back(operation);
    return add_slot(SlotKind::operation, tape_.operations_.size() - 1);
  }

  int next_slot() const { return static_cast<int>(tape_.slots_.size()); }

  Form translate(const Form& form) const {
    Form sum(form.constant);
    for (const Term& term : form.terms) sum = sum + forms_[static_cast<std::size_t>(term.node)] * term.factor;
    return sum;
  }

  /// The same of states alone, before nodes are made.
  Form translate_early(const Form& form) const {
    Form sum(form.constant);
    for (const Term& term : form.terms)
      sum = sum + Form::of(tape_.state_slots_[static_cast<std::size_t>(graph_[term.node].index)].slot) * term.factor;
    return sum;
  }

  /// A slot with the value of a form of slots.
  int slot_of(const Form& form) {
    if (form.terms.size() == 1 && form.constant == 0.0 && form.terms[0].factor == 1.0) return form.terms[0].node;
    const auto same = std::find(linear_.begin(), linear_.end(), form);
    if (same != linear_.end()) return linear_slots_[static_cast<std::size_t>(same - linear_.begin())];
    linear_.push_back(form);
    if (form.is_constant()) {
      linear_slots_.push_back(add_state({.start = StartKind::constant, .value = form.constant}));
    } else {
      tape_.forms_.push_back(form);
      linear_slots_.push_back(add_slot(SlotKind::linear, tape_.forms_.size() - 1));
    }
    return linear_slots_.back();
  }

  int product(int a, int b) {
    if (a > b) std::swap(a, b);
    const auto [found, is_new] = products_.try_emplace({a, b}, 0);
    if (is_new) {
      found->second =
          add_operation({.rule = Rule::product, .a = a, .b = b, .left = a, .right = b, .first = a, .second = b});
    }
    return found->second;
  }

  Form make(int node) {
    const Node& n = graph_[node];
    const auto operand = [&](std::size_t i) { return slot_of(forms_[static_cast<std::size_t>(n.operands[i])]); };
    switch (n.op) {
      case Op::constant: return n.constant;
      case Op::time: return Form::of(add_state({.start = StartKind::time, .rate = Form(1.0)}));
      case Op::state:
        if (n.index >= tape_.states_) throw InvalidInput("formula", "a rate for each state", "a state without one");
        return Form::of(tape_.state_slots_[static_cast<std::size_t>(n.index)].slot);
      case Op::ephemeris:
        tape_.waves_.push_back({0.0, 0.0, false, n.index});
        return Form::of(add_slot(SlotKind::wave, tape_.waves_.size() - 1));
      case Op::parameter: throw InvalidInput("formula", "numbers for all parameters", "a parameter without one");
      case Op::choose: throw InvalidInput("formula", "a mode for each switch", "a switch without one");
      case Op::linear: return Form::of(slot_of(translate(graph_.linear(node))));
      case Op::to_body: return carry(node);
      case Op::sine: return Form::of(wave_or(Rule::sine, n.operands[0]));
      case Op::cosine: return Form::of(wave_or(Rule::cosine, n.operands[0]));
      case Op::multiply: return Form::of(product(operand(0), operand(1)));
      case Op::divide: {
        const int a = operand(0), b = operand(1), z = next_slot();
        return Form::of(add_operation(
            {.rule = Rule::quotient, .a = a, .b = b, .left = b, .right = z, .first = a, .second = b}));
      }
      default: return Form::of(function(n, operand(0), n.op == Op::angle ? operand(1) : -1));
    }
  }

  int function(const Node& n, int a, int b) {
    const int z = next_slot();
    switch (n.op) {
      case Op::root: return add_operation({.rule = Rule::root, .a = a, .left = z, .right = z});
      case Op::exponential:
        return add_operation(
            {.rule = Rule::exponential, .a = a, .left = a, .right = z, .left_weighted = true, .divided = true});
      case Op::logarithm:
        return add_operation(
            {.rule = Rule::logarithm, .a = a, .left = z, .right = a, .left_weighted = true, .divided = true});
      case Op::tanh:
        add_operation(
            {.rule = Rule::tanh, .a = a, .left = a, .right = z + 1, .left_weighted = true, .divided = true});
        product(z, z);
        return z;
      case Op::power:
        add_operation({.rule = Rule::power_helper, .a = a, .left = a, .right = z + 1, .left_weighted = true,
                       .divided = true});
        return add_operation({.rule = Rule::power, .a = a, .b = z, .constant = n.constant, .left = z + 1, .right = a,
                              .left_weighted = true, .divided = true, .first = a, .second = z});
      default: break;
    }
    // atan2(a, b): (a^2 + b^2) z' = b a' - a b'
    const int squares = slot_of(Form::of(product(a, a)) + Form::of(product(b, b)));
    const int rise = integral(a, b), fall = integral(b, a), angle = next_slot();
    return add_operation({.rule = Rule::angle, .a = a, .b = b, .left = angle, .right = squares,
                          .left_weighted = true, .divided = true, .first = rise, .second = fall});
  }

  int integral(int a, int b) {
    return add_operation(
        {.rule = Rule::integral, .a = a, .b = b, .left = a, .right = b, .left_weighted = true, .divided = true});
  }

  int wave_or(Rule rule, int operand) {
    if (const std::optional<Wave> wave = find_wave(graph_, operand)) {
      tape_.waves_.push_back({wave->phase, wave->rate, rule == Rule::cosine});
      return add_slot(SlotKind::wave, tape_.waves_.size() - 1);
    }
    const int a = slot_of(forms_[static_cast<std::size_t>(operand)]);
    const auto [found, is_new] = pairs_.try_emplace(a, next_slot());
    const int sine = found->second;
    if (is_new) {
      for (const Rule each : {Rule::sine, Rule::cosine})
        add_operation({.rule = each, .a = a, .left = a, .right = each == Rule::sine ? sine + 1 : sine,
                       .left_weighted = true, .divided = true});
    }
    return rule == Rule::sine ? sine : sine + 1;
  }

  Form carry(int node) {
    const Node& n = graph_[node];
    Form sum;
    const auto vectors = find_carried(graph_, n.operands);
    for (const CarriedVector& vector : *vectors) {
      const bool rotates = vector.rate != 0.0;
      const int first = carry_vector(vector, rotates);
      sum = sum + Form::of(first + n.index);
    }
    return sum;
  }

  /// The slot of its first component; a rotating vector has its derivative by the angle after it.
  int carry_vector(const CarriedVector& vector, bool rotates) {
    for (std::size_t i = 0; i < tape_.carried_.size(); ++i) {
      const CarriedVector& known = tape_.carried_[i];
      if (known.cosine == vector.cosine && known.sine == vector.sine && known.phase == vector.phase &&
          known.rate == vector.rate)
        return carried_slots_[i];
    }
    std::array<int, 3> w{first_rate, first_rate + 1, first_rate + 2};
    for (std::size_t i = 0; i < rates_->size(); ++i) w[i] = slot_of(translate_early((*rates_)[i]));
    if (tape_.states_ < first_extra) throw InvalidInput("formula", "the attitude among the states", "fewer states");
    const int first = next_slot();
    for (int part = 0; part < (rotates ? 2 : 1); ++part) {
      carried_slots_.push_back(next_slot());
      for (int i = 0; i < 3; ++i)
        add_state({.start = StartKind::carried, .number = 3 * static_cast<int>(tape_.carried_.size()) + i});
      CarriedVector kept = vector;
      if (part == 1) kept.cosine = vector.sine, kept.sine = -vector.cosine;
      tape_.carried_.push_back(kept);
    }
    for (int part = 0; part < (rotates ? 2 : 1); ++part) {
      const int own = first + 3 * part, other = first + 3 * (1 - part);
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        Form rate = Form::of(product(own + j, w[static_cast<std::size_t>(k)])) -
                    Form::of(product(own + k, w[static_cast<std::size_t>(j)]));
        if (rotates) rate = rate + Form::of(other + i) * (part == 0 ? vector.rate : -vector.rate);
        tape_.state_slots_[static_cast<std::size_t>(tape_.slots_[static_cast<std::size_t>(own + i)].index)].rate = rate;
      }
    }
    return first;
  }

  Tape& tape_;
  const Graph& graph_;
  const std::vector<Form>* rates_ = nullptr;
  std::vector<Form> forms_, linear_;   // of slots: of each node; those that have a slot
  std::vector<int> linear_slots_, carried_slots_;
  std::map<std::pair<int, int>, int> products_;
  std::map<int, int> pairs_;
};

Tape::Tape(const Program& system, int states) {
  const Program ready = expand_rotations(system, true);
  Builder(*this, ready, states);
}

int Tape::count(Rule rule) const {
  return static_cast<int>(std::count_if(operations_.begin(), operations_.end(),
                                        [&](const Recurrence& op) { return op.rule == rule; }));
}

void Tape::start(math::DD t, const double* y, double* values) const {
  for (const StateSlot& state : state_slots_) {
    double& value = *values++;
    switch (state.start) {
      case StartKind::given: value = y[state.number]; break;
      case StartKind::time: value = t.hi; break;
      case StartKind::constant: value = state.value; break;
      case StartKind::carried: {
        // three components at once, at the first of them
        if (state.number % 3 != 0) break;
        const CarriedVector& vector = carried_[static_cast<std::size_t>(state.number / 3)];
        double c = 1.0, s = 0.0;
        if (vector.rate != 0.0) {
          fill_wave({vector.phase, vector.rate, true}, t, 1.0, 0, &c, 1);
          fill_wave({vector.phase, vector.rate, false}, t, 1.0, 0, &s, 1);
        }
        const double* q = y + first_attitude;
        const Vector3d seen =
            rotate({-q[0], -q[1], -q[2], q[3]}, s != 0.0 ? Vector3d(c * vector.cosine + s * vector.sine)
                                                         : Vector3d(c * vector.cosine));
        for (int i = 0; i < 3; ++i) (&value)[i] = seen[i];
      }
    }
  }
}

void Tape::set_forms(std::vector<Form> forms, std::vector<Form> rates, std::vector<Form> extras) {
  forms_ = std::move(forms), extras_ = std::move(extras);
  for (std::size_t i = 0; i < rates.size(); ++i) state_slots_[i].rate = std::move(rates[i]);
}

}  // namespace polhode::formula
