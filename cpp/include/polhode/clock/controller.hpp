#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "polhode/core/error.hpp"
#include "polhode/formula/parser.hpp"
#include "polhode/formula/trace.hpp"
#include "polhode/torque/magnetic_field.hpp"

namespace polhode {

/// What a controller commands.
enum class Output {
  torque,          ///< on the body, three numbers, body axes [N m]
  dipole,          ///< a magnetic moment in the field, three numbers, body axes [A m^2]
  rotor_torque,    ///< of the motors of free rotors, one number each [N m]
  rotor_momentum   ///< of held rotors, one number each [N m s]
};
std::string_view to_text(Output output);
/// @throws InvalidInput for another word
Output to_output(const std::string& word);

/// Errors of what a controller measures. A draw depends on the seed, the quantity, the number of the controller and the
/// tick alone.
struct Measure {
  double omega_noise = 0.0;      ///< standard deviation of each component [rad/s]
  double attitude_noise = 0.0;   ///< of each component of a small rotation on the side of the body [rad]
  double field_noise = 0.0;      ///< [T]
  double omega_quantum = 0.0;    ///< each component is rounded to a multiple of it, halves to even [rad/s]
  std::uint64_t seed = 0;

  /// @throws InvalidInput for a number that is negative or not finite
  void check() const;
  friend bool operator==(const Measure&, const Measure&) = default;
};

/// The law of a controller as texts of formulas. Their names: t, omega, attitude, field, speed, the states and the
/// parameters.
struct ControllerLaw {
  std::string command;
  std::vector<double> initial;                            ///< command before the first tick
  std::vector<formula::Input> states = {};                ///< its memory, with its starts
  std::vector<std::string> updates = {};                  ///< new values of the states
  std::vector<formula::Input> parameters = {};
  std::vector<std::pair<std::string, std::string>> let = {};

  friend bool operator==(const ControllerLaw&, const ControllerLaw&) = default;
};

/// The parts of a controller, to be filled by name.
struct ControllerParts {
  /// Measured numbers and states to the command and new states, for a law that is no formula. `in` has omega and
  /// attitude, and the numbers of inputs() behind them; `out` has the numbers of inputs(), of which those of the
  /// command and the states are written.
  using Function = std::function<void(double t, const double* in, double* out)>;

  double period = 0.0;                         ///< [s]
  ControllerLaw law = {};                      ///< without texts where there is a function
  Output output = Output::torque;
  double delay = 0.0;                          ///< from a tick to the command's beginning; may exceed the period [s]
  std::optional<double> width = {};            ///< for which a command lasts; else until the next one [s]
  double start = 0.0;                          ///< time of tick 0 [s]
  std::vector<double> limit = {};              ///< of each component's size: none, one for all, or one for each
  std::optional<MagneticField> field = {};
  int rotors = 0;                              ///< of which the speed is measured
  Measure measure = {};
  Function function = {};
};

/// A program that samples the motion at times t_k = start + k period, computes a command and holds it.
///
/// Tick k measures the state just before t_k. Its command acts from t_k + delay until the next one acts.
class Controller {
 public:
  /// @throws InvalidInput for numbers out of range, a law that is no formula, and a command of another shape
  explicit Controller(ControllerParts parts);

  /// From a generic callable, called once: it takes a formula::TorqueArguments, whose states include the measured
  /// "field" and "speed", and returns a Result.
  template <class T>
  struct Result {
    std::vector<T> command, states;   ///< the states in the order of their numbers
  };
  template <class Callable>
  static Controller from(const Callable& callable, ControllerParts parts);

  const ControllerParts& parts() const { return parts_; }
  /// The numbers of the law besides omega and attitude: "command", "field", "speed", then the states.
  const std::vector<formula::Input>& inputs() const { return inputs_; }
  /// The law as a program of inputs(): one output for each of their numbers. Parameters are numbers.
  /// @throws InvalidInput for a controller with a function
  formula::Program program() const;
  /// The same with its parameters.
  formula::Program open_program() const;
  std::size_t count_commands() const { return parts_.law.initial.size(); }
  bool is_traced() const { return !parts_.function; }
  double tick(std::uint64_t k) const { return parts_.start + static_cast<double>(k) * parts_.period; }

  /// The names of the states that hold its command in a scene; none before it is in one.
  const std::vector<std::string>& held() const { return held_; }
  Controller with_held(std::vector<std::string> names) const;

 private:
  static std::vector<formula::Input> list_inputs(const ControllerParts& parts);
  static ControllerLaw take_law(formula::Text text, ControllerLaw law);

  ControllerParts parts_;
  std::vector<formula::Input> inputs_;
  std::vector<std::string> held_;
};

/// The torque of a command that is held, on the body or by a dipole, with the command as a state that does not change.
torques::Formula make_held_torque(const Controller& controller, const std::string& name);

template <class Callable>
Controller Controller::from(const Callable& callable, ControllerParts parts) {
  const std::vector<formula::Input> inputs = list_inputs(parts);
  const std::size_t commands = parts.law.initial.size();
  const auto as_torque = [&](const auto& in) {
    const Result<formula::Expr> result = callable(in);
    formula::TorqueResult<formula::Expr> all;
    all.rates = result.command;
    if (all.rates.size() != commands)
      throw InvalidInput("Controller.function", "a command of " + std::to_string(commands) + " numbers",
                         std::to_string(all.rates.size()));
    for (const formula::Input& input : inputs)
      if (input.name == "field" || input.name == "speed") all.rates.resize(all.rates.size() + input.values.size());
    all.rates.insert(all.rates.end(), result.states.begin(), result.states.end());
    return all;
  };
  formula::Text text = formula::print(formula::trace(as_torque, parts.law.parameters, inputs));
  parts.law = take_law(std::move(text), std::move(parts.law));
  return Controller(std::move(parts));
}

}  // namespace polhode
