#include "scene/held_commands.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "polhode/core/error.hpp"
#include "polhode/scene/parameter.hpp"

namespace polhode {

void require_free_name(const SceneParts& parts, const std::string& name) {
  if (formula::find_place(list_states(parts.torques), name).count > 0)
    throw InvalidInput("scene.torques", "without a state of the name " + name, name, "it is a momentum in the body");
}

void add_controllers(SceneParts& parts) {
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
