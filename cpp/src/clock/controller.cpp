#include "polhode/clock/controller.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace polhode {
namespace {

using formula::Input;
using formula::Text;

constexpr std::string_view words[] = {"torque", "dipole", "rotor_torque", "rotor_momentum"};
constexpr const char* reserved[] = {"command", "field", "speed", "t", "omega", "attitude", "pi"};

void require_not_negative(const char* where, double value) {
  if (!(value >= 0.0 && std::isfinite(value))) throw InvalidInput(where, "0 or positive, and finite", to_text(value));
}

void require_positive(const char* where, double value) {
  if (!(value > 0.0 && std::isfinite(value))) throw InvalidInput(where, "positive and finite", to_text(value));
}

bool moves_rotors(Output output) { return output == Output::rotor_torque || output == Output::rotor_momentum; }

void require_names(const ControllerParts& parts) {
  const auto check = [](const char* where, const std::string& name) {
    if (std::find(std::begin(reserved), std::end(reserved), name) != std::end(reserved))
      throw InvalidInput(where, "named otherwise", name, "a controller's law has this name for itself");
  };
  for (const Input& state : parts.law.states) check("Controller.states", state.name);
  for (const Input& parameter : parts.law.parameters) check("Controller.parameters", parameter.name);
  for (const auto& [name, text] : parts.law.let) check("Controller.let", name);
}

void require_numbers(const char* where, const std::vector<Input>& inputs) {
  for (const Input& input : inputs)
    for (const double value : input.values)
      if (!std::isfinite(value)) throw InvalidInput(where + ("." + input.name), "finite", to_text(value));
}

/// The law as a torque's text: its command and its states are rates.
Text make_text(const ControllerLaw& law, const std::vector<Input>& inputs) {
  Text text{"[0, 0, 0]", law.parameters, inputs, {law.command}, law.let};
  for (std::size_t i = 1; i + law.states.size() < inputs.size(); ++i) text.rates.push_back(inputs[i].name);
  text.rates.insert(text.rates.end(), law.updates.begin(), law.updates.end());
  return text;
}

}  // namespace

std::string_view to_text(Output output) { return words[static_cast<std::size_t>(output)]; }

Output to_output(const std::string& word) {
  const auto found = std::find(std::begin(words), std::end(words), word);
  if (found == std::end(words))
    throw InvalidInput("Controller.output", "'torque', 'dipole', 'rotor_torque' or 'rotor_momentum'", "'" + word + "'");
  return static_cast<Output>(found - std::begin(words));
}

void Measure::check() const {
  require_not_negative("Measure.omega_noise", omega_noise);
  require_not_negative("Measure.attitude_noise", attitude_noise);
  require_not_negative("Measure.field_noise", field_noise);
  require_not_negative("Measure.omega_quantum", omega_quantum);
}

std::vector<Input> Controller::list_inputs(const ControllerParts& parts) {
  std::vector<Input> inputs = {{"command", parts.law.initial}};
  if (parts.field) inputs.push_back({"field", std::vector<double>(3)});
  if (parts.rotors > 0) inputs.push_back({"speed", std::vector<double>(static_cast<std::size_t>(parts.rotors))});
  inputs.insert(inputs.end(), parts.law.states.begin(), parts.law.states.end());
  return inputs;
}

ControllerLaw Controller::take_law(Text text, ControllerLaw law) {
  law.let = std::move(text.let);
  law.command = text.rates[0];
  law.updates.assign(text.rates.end() - static_cast<std::ptrdiff_t>(law.states.size()), text.rates.end());
  return law;
}

Controller::Controller(ControllerParts parts) : parts_(std::move(parts)) {
  require_positive("Controller.period", parts_.period);
  require_not_negative("Controller.delay", parts_.delay);
  if (!std::isfinite(parts_.start)) throw InvalidInput("Controller.start", "finite", to_text(parts_.start));
  if (parts_.width) {
    require_positive("Controller.width", *parts_.width);
    if (*parts_.width > parts_.period)
      throw InvalidInput("Controller.width", "at most the period, " + to_text(parts_.period), to_text(*parts_.width));
    if (parts_.output == Output::rotor_momentum)
      throw InvalidInput("Controller.width", "left out for rotor_momentum", to_text(*parts_.width),
                         "a momentum is a state, not a pulse");
  }
  const std::size_t commands = parts_.law.initial.size();
  if (!moves_rotors(parts_.output) && commands != 3)
    throw InvalidInput("Controller.initial", "three numbers", std::to_string(commands));
  if (moves_rotors(parts_.output) && (commands == 0 || static_cast<int>(commands) != parts_.rotors))
    throw InvalidInput("Controller.initial", "one number for each rotor, " + std::to_string(parts_.rotors),
                       std::to_string(commands));
  if (!parts_.limit.empty() && parts_.limit.size() != 1 && parts_.limit.size() != commands)
    throw InvalidInput("Controller.limit", "one number, or one for each component of the command",
                       std::to_string(parts_.limit.size()) + " numbers");
  for (const double limit : parts_.limit) require_positive("Controller.limit", limit);
  if (parts_.output == Output::dipole && !parts_.field)
    throw InvalidInput("Controller.field", "given with output 'dipole'", "none", "the command is a moment in a field");
  if (parts_.measure.field_noise > 0.0 && !parts_.field)
    throw InvalidInput("Measure.field_noise", "0 without Controller.field", to_text(parts_.measure.field_noise));
  parts_.measure.check();
  require_names(parts_);
  require_numbers("Controller.initial", {{"command", parts_.law.initial}});
  require_numbers("Controller.states", parts_.law.states);
  inputs_ = list_inputs(parts_);
  if (!is_traced()) return;
  if (parts_.law.updates.size() != parts_.law.states.size())
    throw InvalidInput("Controller.update", "one text for each state", std::to_string(parts_.law.updates.size()));
  program();
}

formula::Program Controller::program() const {
  const formula::Program open = open_program();
  const formula::Program program = formula::bind_parameters(open, formula::list_values(open.parameters));
  return formula::rewrite(formula::expand_rotations(program));
}

formula::Program Controller::open_program() const {
  if (!is_traced()) throw InvalidInput("Controller", "a law that is a formula", "a function");
  formula::Program program;
  try {
    program = formula::parse(make_text(parts_.law, inputs_));
  } catch (const InvalidInput& refusal) {   // the fields of a torque's text have other names here
    std::string text = refusal.what();
    const auto replace = [&](const std::string& from, const std::string& to) {
      if (const std::size_t at = text.find(from); at != std::string::npos) text.replace(at, from.size(), to);
    };
    replace("states.command.rate", "command");
    for (const Input& state : parts_.law.states) replace("states." + state.name + ".rate", "update." + state.name);
    replace("Formula.", ""), replace("formula.", "");
    throw InvalidInput("Controller." + text);
  }
  program.outputs.erase(program.outputs.begin(), program.outputs.begin() + 3);
  return program;
}

Controller Controller::with_held(std::vector<std::string> names) const {
  Controller other = *this;
  other.held_ = std::move(names);
  return other;
}

torques::Formula make_held_torque(const Controller& controller, const std::string& name) {
  using formula::Expr;
  const ControllerParts& parts = controller.parts();
  const auto law = [&](const auto& in) {
    const formula::Vec<Expr, 3> command = in.template s<3>(name);
    formula::TorqueResult<Expr> result{command, {0.0, 0.0, 0.0}};
    if (parts.output == Output::dipole) result.torque = cross(command, to_body(in.attitude, parts.field->see(in.t)));
    return result;
  };
  return torques::Formula::from(law, {}, false, {{name, parts.law.initial}});
}

}  // namespace polhode
