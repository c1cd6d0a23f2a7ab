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
/// What it depends on follows from its structure. solve() replaces a formula that is a torque of the list by it.
class Formula {
 public:
  /// @param recognise  whether solve() may replace it
  /// @throws InvalidInput for a text that is no formula, a torque without three components, and for states
  explicit Formula(const formula::Text& text, bool recognise = true);
  explicit Formula(const formula::Program& program, bool recognise = true);

  /// From a generic callable, called once: `[](const auto& in) { return in.omega * -in.p("kd"); }`, where `in` is a
  /// formula::TorqueArguments.
  template <class Callable>
  static Formula from(const Callable& callable, std::vector<formula::Input> parameters = {}, bool recognise = true) {
    return Formula(formula::trace(callable, std::move(parameters)), recognise);
  }

  static const TorqueRecord& record();

  const formula::Text& text() const;                      ///< parse() makes an equal formula of it
  const std::vector<formula::Input>& parameters() const;
  const formula::Program& program() const;                ///< with the parameters as numbers
  bool recognise() const { return recognise_; }

  formula::Program law(const Matrix3d&) const { return program(); }
  bool has_switches() const;

  TorqueTraits traits() const;
  /// A result that is not finite is passed on and ends the run.
  void add(const TorqueInput& in, double* tau_B) const;
  double compute_potential(const TorqueInput&) const { return 0.0; }   ///< none is known: see traits()

  /// The same torque as a compiled function with these dependencies, which steppers without series integrate.
  Custom as_custom() const;

  /// The same operations and parameters.
  friend bool operator==(const Formula& a, const Formula& b);

 private:
  struct Parts;

  std::shared_ptr<const Parts> parts_;
  bool recognise_;
};

}  // namespace polhode::torques
