#include <algorithm>
#include <cmath>

#include "polhode/formula/tape.hpp"

namespace polhode::formula {
namespace {

/// One number at a time, with rows stored by slot.
class Reference {
 public:
  Reference(const Tape& tape, Rounding rounding, int order)
      : tape_(tape), fused_(rounding == Rounding::fused), order_(order), slots_(static_cast<int>(tape.slots().size())),
        values_(static_cast<std::size_t>(slots_ * (order + 1))), starts_(tape.operations().size()) {}

  void run(math::DD t, double unit, const double* y) {
    std::vector<double> start(tape_.state_slots().size());
    tape_.start(t, y, start.data());
    for (std::size_t i = 0; i < start.size(); ++i) at(0, tape_.state_slots()[i].slot) = start[i];
    std::vector<std::ptrdiff_t> places(tape_.waves().size(), -1);
    for (int slot = 0; slot < slots_; ++slot) {
      const Slot& s = tape_.slots()[static_cast<std::size_t>(slot)];
      if (s.kind == SlotKind::wave) places[static_cast<std::size_t>(s.index)] = slot;
    }
    tape_.fill_waves(t, unit, order_, places, values_.data(), slots_);
    for (int n = 0; n <= order_; ++n) {
      for (int slot = 0; slot < slots_; ++slot) {
        const Slot& s = tape_.slots()[static_cast<std::size_t>(slot)];
        const auto index = static_cast<std::size_t>(s.index);
        if (s.kind == SlotKind::linear) at(n, slot) = sum(tape_.forms()[index], n);
        if (s.kind == SlotKind::operation) at(n, slot) = advance(s.index, n);
      }
      if (n == order_) return;
      for (const StateSlot& state : tape_.state_slots())
        at(n + 1, state.slot) = integrate(sum(state.rate, n), unit, n + 1);
    }
  }

  double& at(int n, int slot) { return values_[static_cast<std::size_t>(n * slots_ + slot)]; }

  /// A form of row n. Its constant belongs to row 0.
  double sum(const Form& form, int n) {
    double total = n == 0 ? form.constant : 0.0;
    for (const Term& term : form.terms) total = madd(term.factor, at(n, term.node), total);
    return total;
  }

 private:
  double madd(double a, double b, double c) const { return fused_ ? std::fma(a, b, c) : a * b + c; }

  /// Division by 3 is the only one of the first rows that rounds; its error would be the same in each step.
  static double integrate(double rate, double unit, int n) {
    return n == 3 ? rate * unit / 3.0 : rate * (unit * (1.0 / n));
  }

  /// The terms of row n that lie among rows below n, rounded down to an even number, less 2; then the later ones. So
  /// kernels sum two rows in one pass over the older rows.
  double sum_older(const Recurrence& op, int n) {
    double total = 0.0;
    const auto add = [&](int j) {
      const double left = at(j, op.left) * (op.left_weighted ? static_cast<double>(j) : 1.0);
      total = madd(left, at(n - j, op.right), total);
    };
    const int even = n - n % 2;
    for (int j = n - even + 2; j <= even - 2; ++j) add(j);
    for (int s = std::max(even - 1, (n + 1) / 2); s < n; ++s) {
      add(s);
      if (s != n - s) add(n - s);
    }
    return total;
  }

  double advance(int index, int n) {
    const Recurrence& op = tape_.operations()[static_cast<std::size_t>(index)];
    RecurrenceStart& start = starts_[static_cast<std::size_t>(index)];
    if (n == 0) {
      start = start_recurrence(op, at(0, op.a), op.b >= 0 ? at(0, op.b) : 0.0);
      return start.value;
    }
    double total = sum_older(op, n);
    if (op.rule != Rule::product) total = total * (op.divided ? start.alpha * (1.0 / n) : start.alpha);
    return madd(start.c1, at(n, op.first), madd(start.c2, at(n, op.second), total));
  }

  const Tape& tape_;
  bool fused_;
  int order_, slots_;
  std::vector<double> values_;
  std::vector<RecurrenceStart> starts_;
};

}  // namespace

void compute_series(const Tape& tape, Rounding rounding, math::DD t, double unit, const double* y, int order,
                    double* rows, double* extras) {
  Reference reference(tape, rounding, order);
  reference.run(t, unit, y);
  for (int n = 0; n <= order; ++n) {
    for (const StateSlot& state : tape.state_slots())
      if (state.start == StartKind::given && state.number < tape.states())
        rows[n * tape.states() + state.number] = reference.at(n, state.slot);
    for (int i = 0; extras != nullptr && i < tape.extras(); ++i)
      extras[n * tape.extras() + i] = reference.sum(tape.extra_forms()[static_cast<std::size_t>(i)], n);
  }
}

}  // namespace polhode::formula
