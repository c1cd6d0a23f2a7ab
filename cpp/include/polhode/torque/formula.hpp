#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "polhode/formula/parser.hpp"
#include "polhode/formula/trace.hpp"
#include "polhode/torque/custom.hpp"
#include "polhode/torque/record.hpp"

namespace polhode::torques {

/// A user's own torque as a formula: from text, or traced from a generic callable. Copies share the formula.
///
/// What it depends on follows from its structure. solve() replaces a formula that is a torque of the list by it. A
/// formula may have states of its own, such as the momentum of a wheel, with their rates.
class Formula {
 public:
  /// @param recognise  whether solve() may replace it
  /// @throws InvalidInput for a text that is no formula, a torque without three components, or a state without a rate
  explicit Formula(const formula::Text& text, bool recognise = true);
  /// @param program  of a torque, or of a potential V with one output: tau_i = -dV(q exp(e_i a / 2))/da at a = 0
  explicit Formula(const formula::Program& program, bool recognise = true);

  /// From a generic callable, called once: `[](const auto& in) { return in.omega * -in.p("kd"); }`, where `in` is a
  /// formula::TorqueArguments.
  /// @param states  with their starts; the callable then returns a formula::TorqueResult
  template <class Callable>
  static Formula from(const Callable& callable, std::vector<formula::Input> parameters = {}, bool recognise = true,
                      std::vector<formula::Input> states = {}) {
    return Formula(formula::trace(callable, std::move(parameters), std::move(states)), recognise);
  }

  /// The formula of a law of the library. Its last parameter may be the inertia, which each call then gives.
  static Formula of_law(const formula::Program& open_law);

  static const TorqueRecord& record();

  const formula::Text& text() const;                      ///< parse() makes an equal formula of it
  const std::vector<formula::Input>& parameters() const;
  /// With the parameters as numbers. The inertia is left, where a law has it.
  const formula::Program& program() const;
  formula::Program program(const Matrix3d& inertia_B) const;
  /// As it was given: with its parameters, or as a potential.
  formula::Program given() const;
  const std::vector<formula::Input>& states() const;      ///< with their starts
  /// A copy whose states start from other numbers, in their order.
  Formula with_starts(const std::vector<double>& starts) const;
  /// A copy with other numbers of its parameters, in their order.
  Formula with_parameters(const std::vector<double>& values) const;
  bool recognise() const { return recognise_; }
  /// A copy that solve() does not replace.
  Formula as_given() const;

  /// The torque as a formula of its parameters.
  formula::Program law(const Matrix3d& inertia_B) const;
  bool has_switches() const;

  TorqueTraits traits() const;
  /// tau_B for given numbers of its states, and their rates. @return 3 numbers and one for each state
  std::vector<double> compute(const TorqueInput& in, const std::vector<double>& states) const;
  /// A result that is not finite is passed on and ends the run. The states are those of the start.
  void add(const TorqueInput& in, double* tau_B) const;
  /// Adds d tau_B / d w_B, from the differentiated formula, which is made at the first call.
  void add_rate_slopes(const TorqueInput& in, Matrix3d& slopes) const;
  double compute_potential(const TorqueInput& in) const;   ///< [J]; 0 where none was given: see traits()

  /// The same torque as a compiled function with these dependencies, which steppers without series integrate.
  /// @throws InvalidInput for one with states
  Custom as_custom(const Matrix3d& inertia_B) const;

  /// The same operations and parameters.
  friend bool operator==(const Formula& a, const Formula& b);

 private:
  struct Parts;
  Formula(std::shared_ptr<const Parts> parts, bool recognise) : parts_(std::move(parts)), recognise_(recognise) {}

  std::shared_ptr<const Parts> parts_;
  bool recognise_;
};

}  // namespace polhode::torques
