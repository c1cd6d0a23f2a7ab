#include "polhode/scene/parameter.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "polhode/core/error.hpp"

namespace polhode {
namespace {

using Of = SceneParameter::Of;
using torques::Window;

/// "torques.0.weight" or "gravity.weight" in its parts; `index` is none where the text has no number.
struct GroupName {
  std::string_view what, field;
  std::optional<std::size_t> index;
};

GroupName split(std::string_view group) {
  const std::size_t first = group.find('.'), last = group.rfind('.');
  if (first == std::string_view::npos) return {group, {}, {}};
  GroupName name{group.substr(0, first), group.substr(last + 1), {}};
  if (last == first) return name;
  const std::string_view number = group.substr(first + 1, last - first - 1);
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), index);
  if (error == std::errc() && end == number.data() + number.size()) name.index = index;
  return name;
}

[[noreturn]] void refuse(std::string_view group, const std::string& requirement) {
  throw InvalidInput("sensitivity", requirement, "'" + std::string(group) + "'");
}

const TorqueRecord& find_record(const AnyTorque& torque) {
  return std::visit([](const auto& one) -> const TorqueRecord& { return one.record(); }, drop_windows(torque));
}

std::size_t find_torque(const Scene& scene, std::string_view group, const GroupName& name) {
  const auto& torques = scene.torques();
  if (name.what == "torques") {
    if (const std::size_t count = scene.given_torques().size(); !name.index || *name.index >= count)
      refuse(group, "of a torque from 'torques.0' on, of which the scene has " + std::to_string(count));
    return *name.index;
  }
  std::optional<std::size_t> found;
  for (std::size_t i = 0; i < torques.size(); ++i) {
    if (find_record(torques[i]).key != name.what) continue;
    if (found) refuse(group, "'torques.0', 'torques.1' and so on where the scene has two of a kind");
    found = i;
  }
  if (!found)
    refuse(group, "'omega', 'attitude', 'inertia', 'axes', or a number of a torque or a rotor of the scene, as "
                  "'torques.0.weight' or 'rotors.0.momentum'");
  return *found;
}

void add_windows(std::span<const Window> windows, Of of, std::size_t index, const std::string& prefix,
                 std::vector<SceneParameter>& found) {
  for (std::size_t i = 0; i < windows.size(); ++i) {
    for (const int end : {0, 1}) {
      if (!std::isfinite(end == 0 ? windows[i].begin : windows[i].end)) continue;
      found.push_back({of, index, static_cast<int>(i), end,
                       prefix + "_" + std::to_string(i) + (end == 0 ? "_begin" : "_end")});
    }
  }
}

/// What a number of a formula's input has after the name: nothing, "_x" of three, or "_0".
std::string name_part(int i, int count) {
  if (count == 1) return "";
  std::string part = "_";   // GCC 12 sees an overlap in "_" + a string
  return count == 3 ? part.append(1, "xyz"[i]) : part.append(std::to_string(i));
}

std::vector<SceneParameter> find_torque_parameters(const Scene& scene, std::string_view group, const GroupName& name) {
  using Kind = TorqueParameter::Kind;
  const std::size_t index = find_torque(scene, group, name);
  const AnyTorque& torque = scene.torques()[index];
  const TorqueRecord& record = find_record(torque);
  const std::string prefix = "torques." + std::to_string(index) + "." + std::string(name.field);
  std::vector<SceneParameter> found;
  if (const auto* during = std::get_if<torques::During>(&torque); during != nullptr && name.field == "windows") {
    add_windows(during->windows(), Of::torque_windows, index, prefix, found);
    return found;
  }
  std::string known;
  if (const LastingTorque lasting = drop_windows(torque); std::holds_alternative<torques::Formula>(lasting)) {
    const std::vector<formula::Input>& own = std::get<torques::Formula>(lasting).parameters();
    for (std::size_t field = 0; field < own.size(); ++field) {
      known += (known.empty() ? "'" : ", '") + own[field].name + "'";
      const std::size_t count = own[field].values.size();
      for (std::size_t c = 0; own[field].name == name.field && c < count; ++c)
        found.push_back({Of::torque, index, static_cast<int>(field), static_cast<int>(c),
                         prefix + name_part(static_cast<int>(c), static_cast<int>(count))});
    }
  }
  for (std::size_t field = 0; field < record.parameters.size(); ++field) {
    const TorqueParameter& parameter = record.parameters[field];
    if (parameter.kind == Kind::choice) continue;
    known += (known.empty() ? "'" : ", '") + std::string(parameter.name) + "'";
    if (parameter.name != name.field) continue;
    const int count = parameter.kind == Kind::real ? 1 : parameter.kind == Kind::vector ? 3 : 9;
    for (int c = 0; c < count; ++c) {
      std::string column = prefix;
      if (count == 3) column += std::string("_") + "xyz"[c];
      if (count == 9) column += std::string("_") + "xyz"[c / 3] + "xyz"[c % 3];
      found.push_back({Of::torque, index, static_cast<int>(field), c, std::move(column)});
    }
  }
  if (found.empty()) {
    refuse(group, "a number of " + std::string(record.name) + ", which has " + (known.empty() ? "none" : known) +
                      (std::holds_alternative<torques::During>(torque) ? " and 'windows'" : ""));
  }
  return found;
}

/// A number of what acts on a driven rotor or a damper.
void add_drive(const Scene& scene, std::string_view state, std::string_view field, const std::string& prefix,
               std::vector<SceneParameter>& found) {
  const std::size_t index = find_torque_of_state(scene, state);
  const torques::Formula& formula = *find_formula(scene.torques()[index]);
  const int number = find_field(formula, field);
  if (number < 0 || field == "axis" || field == "inertia") return;
  const auto count = static_cast<int>(formula.parameters()[static_cast<std::size_t>(number)].values.size());
  for (int c = 0; c < count; ++c)
    found.push_back({Of::torque, index, number, c, prefix + name_part(c, count)});
}

std::vector<SceneParameter> find_damper_parameters(const Scene& scene, std::string_view group, std::string_view field) {
  std::vector<SceneParameter> found;
  if (scene.damper()) add_drive(scene, scene.damper()->state(), field, std::string(group), found);
  if (found.empty()) refuse(group, "'damper.viscous' of a scene with a damper");
  return found;
}

std::vector<SceneParameter> find_rotor_parameters(const Scene& scene, std::string_view group, const GroupName& name) {
  const std::vector<Rotor>& rotors = scene.rotors();
  const std::optional<std::size_t> index = name.what == "rotor" && rotors.size() == 1 ? 0 : name.index;
  if (!index || *index >= rotors.size())
    refuse(group, "of a rotor from 'rotors.0' on, of which the scene has " + std::to_string(rotors.size()));
  const Rotor& rotor = rotors[*index];
  const std::string prefix = "rotors." + std::to_string(*index) + "." + std::string(name.field);
  std::vector<SceneParameter> found;
  const auto add = [&](std::string_view field, bool given, int number) {
    if (name.field == field && given) found.push_back({Of::rotor, *index, number, 0, prefix});
  };
  add("momentum", rotor.momentum().has_value(), SceneParameter::momentum);
  add("inertia", rotor.inertia().has_value(), SceneParameter::inertia);
  add("speed", rotor.speed().has_value(), SceneParameter::speed);
  if (name.field == "during") add_windows(rotor.windows(), Of::rotor_windows, *index, prefix, found);
  if (found.empty() && rotor.is_driven()) add_drive(scene, rotor.state(), name.field, prefix, found);
  if (found.empty())
    refuse(group, "'momentum', 'inertia', 'speed', 'during', or a number of its motor or friction, of a rotor that was "
                  "given it");
  return found;
}

std::vector<SceneParameter> find_controller_parameters(const Scene& scene, std::string_view group, const GroupName& name) {
  const std::vector<Controller>& controllers = scene.controllers();
  if (!name.index || *name.index >= controllers.size())
    refuse(group, "of a controller from 'controllers.0' on, of which the scene has " + std::to_string(controllers.size()));
  const ControllerLaw& law = controllers[*name.index].parts().law;
  const std::string prefix = "controllers." + std::to_string(*name.index) + "." + std::string(name.field);
  std::vector<SceneParameter> found;
  std::string known;
  const auto add = [&](const std::vector<formula::Input>& inputs, Of of) {
    int number = 0;
    for (const formula::Input& input : inputs) {
      known += (known.empty() ? "'" : ", '") + input.name + "'";
      const auto count = static_cast<int>(input.values.size());
      for (int c = 0; c < count; ++c, ++number)
        if (input.name == name.field) found.push_back({of, *name.index, 0, number, prefix + name_part(c, count)});
    }
  };
  add(law.parameters, Of::controller), add(law.states, Of::controller_state);
  if (found.empty())
    refuse(group, "a parameter or a state of the controller's law, which has " + (known.empty() ? "none" : known));
  return found;
}

std::vector<SceneParameter> find_state(const Scene& scene, std::string_view group, const GroupName& name) {
  const formula::Place place = formula::find_place(scene.states(), name.field);
  if (place.first < 0) {
    std::string known;
    for (const formula::Input& state : scene.states()) known += (known.empty() ? "'" : ", '") + state.name + "'";
    refuse(group, "a state of the scene's formulas, which has " + (known.empty() ? "none" : known));
  }
  std::vector<SceneParameter> found;
  for (int i = 0; i < place.count; ++i)
    found.push_back({Of::state, static_cast<std::size_t>(place.first + i), 0, 0,
                     std::string(group) + name_part(i, place.count)});
  return found;
}

}  // namespace

std::size_t find_torque_of_state(const Scene& scene, std::string_view state) {
  std::size_t i = 0;
  for (; i < scene.torques().size(); ++i) {
    const torques::Formula* formula = find_formula(scene.torques()[i]);
    if (formula != nullptr && formula::find_place(formula->states(), state).count > 0) break;
  }
  return i;
}

int find_field(const torques::Formula& formula, std::string_view name) {
  const std::vector<formula::Input>& own = formula.parameters();
  const auto found = std::find_if(own.begin(), own.end(), [&](const formula::Input& input) { return input.name == name; });
  return found == own.end() ? -1 : static_cast<int>(found - own.begin());
}

std::vector<SceneParameter> find_parameters(const Scene& scene, std::string_view group) {
  constexpr std::pair<std::string_view, Of> triples[] = {
      {"omega", Of::omega}, {"attitude", Of::attitude}, {"inertia", Of::inertia}, {"axes", Of::axes}};
  for (const auto& [name, of] : triples) {
    if (group != name) continue;
    std::vector<SceneParameter> found;
    for (int c = 0; c < 3; ++c)
      found.push_back({of, 0, 0, c, std::string(name) + "_" + (of == Of::inertia ? "123" : "xyz")[c]});
    return found;
  }
  const GroupName name = split(group);
  if (name.what == "rotors" || name.what == "rotor") return find_rotor_parameters(scene, group, name);
  if (name.what == "controllers") return find_controller_parameters(scene, group, name);
  if (name.what == "damper") return find_damper_parameters(scene, group, name.field);
  if (name.what == "states") return find_state(scene, group, name);
  return find_torque_parameters(scene, group, name);
}

}  // namespace polhode
