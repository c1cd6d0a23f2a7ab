#include "scene/held_commands.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "polhode/core/error.hpp"
#include "polhode/scene/parameter.hpp"
#include "polhode/torque/formula.hpp"

namespace polhode {

void require_free_name(const SceneParts& parts, const std::string& name) {
  if (formula::find_place(list_states(parts.torques), name).count > 0)
    throw InvalidInput("scene.torques", "without a state of the name " + name, name, "it is a momentum in the body");
}

/// The torque times a state that is held.
torques::Formula make_held_window(const torques::During& during, const std::string& state, const SceneParts& parts,
                                  const std::string& where) {
  if (std::holds_alternative<torques::Custom>(during.torque()))
    throw InvalidInput(where, "no Custom torque beside controllers", "one",
                       "it has no Taylor series; write it as a Formula");
  formula::Program law = make_law(to_any(during.torque()), parts.inertia_B.matrix());
  if (!law.states.empty())
    throw InvalidInput(where, "without windows beside controllers, as a formula with states is", "windows",
                       "what its states do between windows is not known");
  law.states.push_back({state, {during.acts_at(parts.t0) ? 1.0 : 0.0}});
  const formula::Expr held(law.graph, law.graph.state(formula::first_extra));
  for (std::size_t i = 0; i < 3; ++i) law.outputs[i] = (held * formula::Expr(law.graph, law.outputs[i])).form();
  law.outputs.push_back(formula::Form(0.0));
  return torques::Formula(law, false);
}

void hold_windows(SceneParts& parts) {
  for (std::size_t i = 0; i < parts.torques.size(); ++i) {
    const auto* during = std::get_if<torques::During>(&parts.torques[i]);
    if (during == nullptr) continue;
    const std::string where = "scene.torques[" + std::to_string(i) + "]", state = "window_" + std::to_string(i);
    require_free_name(parts, state);
    parts.held_windows.push_back({i, state, *during});
    parts.torques[i] = make_held_window(*during, state, parts, where);
  }
}

void add_controllers(SceneParts& parts) {
  if (!parts.controllers.empty()) hold_windows(parts);
  for (std::size_t i = 0; i < parts.controllers.size(); ++i) {
    Controller& controller = parts.controllers[i];
    if (!controller.held().empty()) continue;
    const std::string where = "scene.controllers[" + std::to_string(i) + "]", name = "command_" + std::to_string(i);
    const Output output = controller.parts().output;
    double latest = std::abs(parts.t0);
    for (const double t : parts.times) latest = std::max(latest, std::abs(t));
    latest = std::max(latest, std::abs(controller.parts().start));
    constexpr double eps = std::numeric_limits<double>::epsilon();
    if (!(controller.parts().period > 16 * eps * latest))
      throw InvalidInput(where + ".period", "above the spacing of the times, " + to_text(16 * eps * latest),
                         to_text(controller.parts().period));
    if (controller.parts().rotors > 0 && static_cast<std::size_t>(controller.parts().rotors) != parts.rotors.size())
      throw InvalidInput(where + ".rotors", "as many as the scene has, " + std::to_string(parts.rotors.size()),
                         std::to_string(controller.parts().rotors));
    if (output == Output::torque || output == Output::dipole) {
      require_free_name(parts, name);
      parts.torques.emplace_back(make_held_torque(controller, name));
      controller = controller.with_held({name});
      continue;
    }
    const bool by_torque = output == Output::rotor_torque;
    std::vector<std::string> held;
    for (std::size_t k = 0; k < parts.rotors.size(); ++k) {
      Rotor& rotor = parts.rotors[k];
      const std::string own = "scene.rotors[" + std::to_string(k) + "]";
      if (rotor.free() != by_torque)
        throw InvalidInput(own + ".free", by_torque ? "True for output 'rotor_torque'" : "False for output 'rotor_momentum'",
                           by_torque ? "False" : "True");
      if (rotor.has_windows()) throw InvalidInput(own + ".during", "left out for a rotor that a controller drives", "windows");
      if (by_torque && !rotor.inertia())
        throw InvalidInput(own + ".inertia", "given for a rotor that a controller drives", "none");
      if (!rotor.command().empty())
        throw InvalidInput(where + ".output", "that of one controller alone", std::string(to_text(output)),
                           "another controller drives the same rotors");
      if (controller.parts().law.initial[k] != 0.0)
        throw InvalidInput(where + ".initial", "left out for rotors", to_text(controller.parts().law.initial[k]),
                           "they start from their own momentum, without a torque");
      rotor = rotor.with_command(name + "_" + std::to_string(k));
      held.push_back(by_torque ? rotor.command() : "rotor_momentum_" + std::to_string(k));
    }
    controller = controller.with_held(std::move(held));
  }
}

}  // namespace polhode
