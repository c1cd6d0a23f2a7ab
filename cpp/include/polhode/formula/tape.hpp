#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "polhode/formula/program.hpp"
#include "polhode/math/detail/double_double.hpp"

namespace polhode::formula {

/// How an operation gets its value and the constants of its recurrence from the values of a and b.
enum class Rule : std::uint8_t {
  product, quotient, root, exponential, logarithm, sine, cosine, tanh,
  integral,       ///< the integral of b da; its value, a constant of integration, is 0
  power_helper,   ///< its rows are those of `older` alone
  power,          ///< a^constant; b is the helper
  angle           ///< atan2(a, b) by the integrals x dy and y dx
};

/// One operation z on slots: z_n = alpha older_n + c1 first_n + c2 second_n for n >= 1, where
/// older_n = sum over 0 < j < n of (j or 1) left_j right_{n-j}.
struct Recurrence {
  Rule rule;
  int a = -1, b = -1;            ///< operands of the value
  double constant = 0.0;
  int left = -1, right = -1;     ///< factors of older
  bool left_weighted = false;    ///< left_j times j
  bool divided = false;          ///< alpha is divided by n
  int first = -1, second = -1;
};

/// The numbers of a recurrence that are constant during a step.
struct RecurrenceStart {
  double value, alpha, c1, c2;
};
/// @param a, b  the values of the operands; for Rule::cosine and its like b is the value of the partner
RecurrenceStart start_recurrence(const Recurrence& operation, double a, double b);

/// A known function of time: sin or cos of phase + rate * time, or a number of an ephemeris.
struct Wave {
  double phase, rate;
  bool cosine;
  int seen = -1;   ///< in an ephemeris: its number times eight and the number's place
};
/// Rows 0..order of a sine or cosine in powers of the time divided by `unit`, with the angle in double-double.
void fill_wave(const Wave& wave, math::DD t, double unit, int order, double* rows, int stride);

/// What a slot is; each slot has one number a row.
enum class SlotKind : std::uint8_t {
  state,      ///< a state, the time, a constant or a carried component: row n + 1 follows from its rate's row n
  wave,       ///< its rows are known at the start of a step
  linear,     ///< a form of other slots
  operation   ///< a recurrence
};

struct Slot {
  SlotKind kind;
  int index;   ///< into the list of its kind
};

enum class StartKind : std::uint8_t { given, time, constant, carried };

/// A slot whose derivative is a form.
struct StateSlot {
  StartKind start;
  int number = 0;        ///< given: the state's number; carried: the component, 3 times the vector's number more
  double value = 0.0;    ///< of a constant
  int slot = -1;
  Form rate = {};        ///< terms name slots
};

/// R_WB^T (cosine cos a + sine sin a), a = phase + rate t. Where the rate is 0, `sine` is unused.
struct CarriedVector {
  Vector3d cosine, sine;
  double phase = 0.0, rate = 0.0;
};

/// Operations and forms with Taylor recurrences: a system y' = f(t, y), y given by numbers, in one pass a row.
///
/// A vector fixed in space, or one that rotates about an axis of space at a constant rate, is carried in body axes:
/// v' = v x w. It starts anew from the attitude at each step. This needs fewer levels than products of the attitude.
class Tape {
 public:
  /// @param system  without parameters (bind_parameters()) and without switches (in_mode()); outputs are the rates
  ///                of states 0, 1, ..., and after `states` of them the extras, returned but not integrated
  /// @throws InvalidInput for a parameter or a switch
  Tape(const Program& system, int states);
  explicit Tape(const Program& system) : Tape(system, static_cast<int>(system.outputs.size())) {}

  int states() const { return states_; }
  int extras() const { return static_cast<int>(extras_.size()); }

  const std::vector<Slot>& slots() const { return slots_; }   ///< operands precede their slot, rows below n excepted
  const std::vector<StateSlot>& state_slots() const { return state_slots_; }
  const std::vector<Wave>& waves() const { return waves_; }
  const std::vector<Form>& forms() const { return forms_; }
  const std::vector<Recurrence>& operations() const { return operations_; }
  const std::vector<Form>& extra_forms() const { return extras_; }
  int count(Rule rule) const;

  const std::vector<CarriedVector>& carried() const { return carried_; }
  const std::vector<Ephemeris>& ephemerides() const { return ephemerides_; }

  /// Rows 0..order of the waves in powers of the time divided by `unit`.
  /// @param places  where in `rows` the numbers of each wave begin, negative for one that is left out
  /// @param stride  from one number to the next
  void fill_waves(math::DD t, double unit, int order, const std::vector<std::ptrdiff_t>& places, double* rows,
                  std::ptrdiff_t stride) const;

  /// Starts of the state slots: given states, time, constants, and what is carried.
  void start(math::DD t, const double* y, double* values) const;

  /// Replaces each number of forms, waves and carried vectors by `change` of it.
  template <class Change>
  void change_constants(const Change& change) {
    const auto change_form = [&](Form& form) {
      form.constant = change(form.constant);
      for (Term& term : form.terms) term.factor = change(term.factor);
    };
    for (auto* forms : {&forms_, &extras_})
      for (Form& form : *forms) change_form(form);
    for (StateSlot& state : state_slots_) state.value = change(state.value), change_form(state.rate);
    for (Wave& wave : waves_) wave.phase = change(wave.phase), wave.rate = change(wave.rate);
    for (CarriedVector& vector : carried_) {
      for (int i = 0; i < 3; ++i) vector.cosine[i] = change(vector.cosine[i]), vector.sine[i] = change(vector.sine[i]);
      vector.phase = change(vector.phase), vector.rate = change(vector.rate);
    }
  }

  /// The same forms with their terms in another order, which decides their bits.
  void set_forms(std::vector<Form> forms, std::vector<Form> rates, std::vector<Form> extras);

 private:
  class Builder;

  int states_ = 0;
  std::vector<Slot> slots_;
  std::vector<StateSlot> state_slots_;
  std::vector<Wave> waves_;
  std::vector<Form> forms_, extras_;
  std::vector<Recurrence> operations_;
  std::vector<CarriedVector> carried_;
  std::vector<Ephemeris> ephemerides_;
};

/// Rounding of a b + c: once, as processors with fused operations do, or twice. It decides the bits.
enum class Rounding { fused, plain };

/// The recurrences one number at a time: what every kernel has the bits of.
/// @param rows    order + 1 rows of tape.states() numbers, in powers of (t - t0) / unit
/// @param extras  order + 1 rows of tape.extras() numbers, or null. Row `order` of them needs no further row of states
void compute_series(const Tape& tape, Rounding rounding, math::DD t, double unit, const double* y, int order,
                    double* rows, double* extras = nullptr);

}  // namespace polhode::formula
