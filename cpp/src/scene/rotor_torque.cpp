#include "scene/rotor_torque.hpp"

#include <algorithm>
#include <string>
#include <string_view>

#include "polhode/core/error.hpp"
#include "polhode/scene/rotor.hpp"

namespace polhode {
namespace {

using formula::Input;
using formula::Text;

/// Names of the formula below, which a motor's own parameters and shared parts must not have.
constexpr const char* reserved[] = {"speed", "axis", "inertia", "viscous", "coulomb", "max_torque", "max_speed", "wanted", "command", "effort", "torque"};

void require_free_names(const Text& law) {
  const auto check = [](const std::string& name) {
    if (std::find(std::begin(reserved), std::end(reserved), name) != std::end(reserved))
      throw InvalidInput("Rotor.torque", "a formula whose names are not those of the rotor", name);
  };
  for (const Input& parameter : law.parameters) check(parameter.name);
  for (const auto& [name, definition] : law.let) check(name);
}

}  // namespace

Text take_motor(Text torque) {
  torque.let.emplace_back("motor", torque.torque);
  torque.torque = "motor.x";
  torque.states.clear(), torque.rates.clear();
  return torque;
}

void require_motor(const Text& law) {
  require_free_names(law);
  Text alone{"[0, 0, 0]", law.parameters, {{"speed", {0.0}}}, {law.torque}, law.let};
  try {
    formula::parse(alone);
  } catch (const InvalidInput& refusal) {
    constexpr std::string_view field = "states.speed.rate";
    std::string words = refusal.what();
    if (const std::size_t at = words.find(field); at != std::string::npos) words.replace(at, field.size(), "torque");
    throw InvalidInput("Rotor." + words);
  }
}

torques::Formula make_torque(const Rotor& rotor, double momentum) {
  const RotorParts& parts = rotor.parts();
  const std::string& h = rotor.state();
  const Vector3d& a = rotor.axis();
  Text text;
  text.states = {{h, {momentum}}};
  text.parameters = {{"axis", {a[0], a[1], a[2]}}};
  if (!rotor.free()) {
    text.torque = "-cross(omega, " + h + " * axis)";
    text.rates = {"0"};
    return torques::Formula(text, false);
  }
  text.parameters.push_back({"inertia", {*rotor.inertia()}});
  text.let = {{"speed", h + " / inertia - dot(axis, omega)"}};
  std::string effort;
  const auto add = [&](const char* name, double value, const std::string& term) {
    text.parameters.push_back({name, {value}});
    effort += term;
  };
  if (parts.law) {
    const Text& law = *parts.law;
    text.parameters.insert(text.parameters.end(), law.parameters.begin(), law.parameters.end());
    text.let.insert(text.let.end(), law.let.begin(), law.let.end());
    effort = law.torque;
  } else if (parts.torque != 0.0) {
    add("torque", parts.torque, "torque");
  }
  if (!rotor.command().empty()) {
    text.states.push_back({rotor.command(), {0.0}});
    effort += (effort.empty() ? "" : " + ") + rotor.command();
  }
  if (parts.max_torque) {
    effort = "clip(" + effort + ", -max_torque, max_torque)";
    add("max_torque", *parts.max_torque, "");
  }
  if (parts.max_speed) {
    // A motor of at most B gives what keeps the speed at its limit, from -B up to its command u, as dry friction of the
    // load (B + u)/2 does. Below the limit that is (B + u)/2, and the other limit's -(B - u)/2.
    text.let.emplace_back("wanted", effort);
    text.parameters.push_back({"max_speed", {*parts.max_speed}});
    const std::string most = parts.max_torque ? "max_torque" : rotor.command().empty() ? "abs(torque)" : "abs(wanted)";
    effort = "friction(0.5 * (" + most + " + wanted), speed - max_speed) + friction(0.5 * (" + most +
             " - wanted), speed + max_speed)";
  }
  if (!effort.empty()) {
    text.let.emplace_back("command", effort);
    effort = "command";
  }
  if (parts.viscous != 0.0) add("viscous", parts.viscous, " - viscous * speed");
  if (parts.coulomb != 0.0) add("coulomb", parts.coulomb, " + friction(coulomb, speed)");
  text.let.emplace_back("effort", effort);
  text.torque = "-cross(omega, " + h + " * axis) - effort * axis";
  text.rates = {"effort"};
  if (!rotor.command().empty()) text.rates.push_back("0");
  return torques::Formula(text, false);
}

}  // namespace polhode
