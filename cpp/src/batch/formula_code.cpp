#include <algorithm>
#include <array>

#include "batch/lanes/formula_block.hpp"

namespace polhode {
namespace {

using formula::Form;
using formula::Recurrence;
using formula::SlotKind;
using formula::StartKind;
using formula::Tape;

/// Where the numbers of each list of a tape begin.
class Numbers {
 public:
  explicit Numbers(const Tape& tape) {
    for (const auto* forms : {&tape.forms(), &tape.extra_forms()}) {
      for (const Form& form : *forms) {
        forms_.push_back(next_);
        next_ += 1 + std::ssize(form.terms);
      }
    }
    extras_ = tape.forms().size();
    values_ = next_, next_ += std::ssize(tape.state_slots());
    vectors_ = next_, next_ += 4 * std::ssize(tape.carried());
  }
  std::ptrdiff_t form(int index) const { return forms_[static_cast<std::size_t>(index)]; }
  std::ptrdiff_t extra(int index) const { return forms_[extras_ + static_cast<std::size_t>(index)]; }
  std::ptrdiff_t value(int state) const { return values_ + state; }
  std::ptrdiff_t vector(int index) const { return vectors_ + 4 * index; }
  std::ptrdiff_t count() const { return next_; }

 private:
  std::vector<std::ptrdiff_t> forms_;
  std::size_t extras_ = 0;
  std::ptrdiff_t next_ = 0, values_ = 0, vectors_ = 0;
};

class Writer {
 public:
  using Place = FormulaCode::Place;

  Writer(FormulaCode& code, const Tape& tape, int order)
      : code_(code), tape_(tape), numbers_(tape), order_(order), used_(tape.slots().size()), series_(used_.size()),
        weighted_(used_.size()), places_(used_.size()), weighted_places_(used_.size()) {}

  void write() {
    find_used();
    for (std::size_t i = 0; i < used_.size(); ++i) {
      if (!used_[i]) continue;
      places_[i] = reserve(series_[i]);
      if (weighted_[i]) weighted_places_[i] = reserve(true);
    }
    for (int i = 0; i < 3; ++i) code_.w_B[i] = code_.w_P[i] = place_of_state(formula::first_rate + i);
    for (int i = 0; i < 3 && code_.rotated; ++i) code_.w_P[i] = reserve(true);
    for (int i = 0; i < 4; ++i) code_.q[i] = place_of_state(formula::first_attitude + i);
    write_states();
    for (int i = 0; i < std::ssize(tape_.slots()); ++i)
      if (used_[at(i)]) write_line(i);
    for (int i = 0; i < 3; ++i) code_.torque[i] = add_sum(tape_.extra_forms()[at(i)], numbers_.extra(i));
    code_.size = static_cast<std::size_t>(size_), code_.numbers = static_cast<std::size_t>(numbers_.count());
  }

 private:
  static constexpr std::ptrdiff_t lanes = LaneState::width;
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }

  Place reserve(bool all_rows) {
    const Place place{size_, all_rows ? lanes : 0};
    size_ += all_rows ? lanes * (order_ + 1) : lanes;
    return place;
  }

  Place place_of_state(int state) const { return places_[at(tape_.state_slots()[at(state)].slot)]; }

  /// Each rate of a carried vector is known; the products that the tape has for it are left out.
  void find_used() {
    const auto use_terms = [&](const Form& form) {
      for (const formula::Term& term : form.terms) used_[at(term.node)] = true;
    };
    for (const Form& extra : tape_.extra_forms()) use_terms(extra);
    // Repeated, because a helper may be a slot behind the one that needs it.
    for (bool changed = true; changed;) {
      const std::vector<bool> before = used_;
      for (int i = static_cast<int>(used_.size()) - 1; i >= 0; --i) use_operands(i, use_terms);
      changed = before != used_;
    }
    for (const formula::StateSlot& state : tape_.state_slots())
      if (state.start == StartKind::given || state.start == StartKind::carried)
        used_[at(state.slot)] = series_[at(state.slot)] = true;
    for (std::size_t i = 0; i < used_.size(); ++i)
      if (tape_.slots()[i].kind == SlotKind::wave || tape_.slots()[i].kind == SlotKind::state) series_[i] = true;
  }

  template <class UseTerms>
  void use_operands(int slot, const UseTerms& use_terms) {
    if (!used_[at(slot)]) return;
    const formula::Slot& s = tape_.slots()[at(slot)];
    if (s.kind == SlotKind::linear) use_terms(tape_.forms()[at(s.index)]);
    if (s.kind != SlotKind::operation) return;
    const Recurrence& op = tape_.operations()[at(s.index)];
    for (const int operand : {op.a, op.b, op.first, op.second, op.left, op.right})
      if (operand >= 0) used_[at(operand)] = true;
    (op.left_weighted ? weighted_ : series_)[at(op.left)] = true;
    series_[at(op.right)] = true;
  }

  void write_states() {
    for (int i = 0; i < std::ssize(tape_.state_slots()); ++i) {
      const formula::StateSlot& state = tape_.state_slots()[at(i)];
      const Place place = places_[at(state.slot)];
      if (state.start == StartKind::time && used_[at(state.slot)]) code_.time.push_back(place);
      if (state.start == StartKind::constant && used_[at(state.slot)])
        code_.constants.push_back({place, numbers_.value(i)});
      if (state.start != StartKind::carried || state.number % 3 != 0) continue;
      FormulaCode::Vector vector;
      const int index = state.number / 3;
      for (int k = 0; k < 3; ++k) vector.place[k] = place_of_state(i + k);
      vector.cosine = numbers_.vector(index), vector.rate = vector.cosine + 3;
      vector.rotates = tape_.carried()[at(index)].rate != 0.0;
      vector.second = vector.rotates && !code_.vectors.empty() && code_.vectors.back().rotates &&
                      !code_.vectors.back().second;
      code_.vectors.push_back(vector);
    }
  }

  FormulaCode::Sum add_sum(const Form& form, std::ptrdiff_t number) {
    FormulaCode::Sum sum{number, code_.terms.size(), 0};
    for (const formula::Term& term : form.terms) code_.terms.push_back({places_[at(term.node)], ++number});
    sum.end = code_.terms.size();
    return sum;
  }

  void write_line(int slot) {
    const formula::Slot& s = tape_.slots()[at(slot)];
    if (s.kind == SlotKind::wave) code_.waves.push_back({places_[at(slot)], s.index});
    if (s.kind == SlotKind::state || s.kind == SlotKind::wave) {
      if (weighted_[at(slot)]) add_weighted(slot);
      return;
    }
    FormulaCode::Line line;
    line.out = places_[at(slot)], line.weighted = weighted_places_[at(slot)];
    if (s.kind == SlotKind::linear) {
      line.sum = add_sum(tape_.forms()[at(s.index)], numbers_.form(s.index));
    } else {
      const Recurrence& op = tape_.operations()[at(s.index)];
      using Kind = FormulaCode::Line::Kind;
      line.kind = op.rule == formula::Rule::product ? Kind::product : Kind::general;
      line.operation = s.index, line.divided = op.divided;
      line.first = places_[at(op.first)], line.second = places_[at(op.second)];
      line.a = places_[at(op.a)], line.b = op.b >= 0 ? places_[at(op.b)] : line.a;
      if (line.kind == Kind::general) line.start = 3 * lanes * static_cast<std::ptrdiff_t>(code_.starts++);
      line.product = std::ssize(code_.products);
      code_.products.push_back({(op.left_weighted ? weighted_places_ : places_)[at(op.left)].offset,
                                places_[at(op.right)].offset});
    }
    code_.lines.push_back(line);
  }

  /// A state's rows times their number, as a sum of itself.
  void add_weighted(int slot) {
    FormulaCode::Line line;
    line.kind = FormulaCode::Line::Kind::copy;
    line.out = places_[at(slot)], line.weighted = weighted_places_[at(slot)];
    code_.lines.push_back(line);
  }

  FormulaCode& code_;
  const Tape& tape_;
  Numbers numbers_;
  int order_;
  std::vector<bool> used_, series_, weighted_;
  std::vector<Place> places_, weighted_places_;
  std::ptrdiff_t size_ = 0;
};

}  // namespace

FormulaCode::FormulaCode(const Tape& tape, bool is_rotated, int order) : rotated(is_rotated) {
  Writer(*this, tape, order).write();
}

std::vector<double> list_numbers(const Tape& tape) {
  std::vector<double> found;
  for (const auto* forms : {&tape.forms(), &tape.extra_forms()}) {
    for (const Form& form : *forms) {
      found.push_back(form.constant);
      for (const formula::Term& term : form.terms) found.push_back(term.factor);
    }
  }
  for (const formula::StateSlot& state : tape.state_slots()) found.push_back(state.value);
  for (const formula::CarriedVector& vector : tape.carried()) {
    found.insert(found.end(), {vector.cosine[0], vector.cosine[1], vector.cosine[2]});
    found.push_back(vector.rate);
  }
  return found;
}

}  // namespace polhode
