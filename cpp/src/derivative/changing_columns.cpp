#include "derivative/changing_columns.hpp"

#include <algorithm>
#include <string_view>

#include "polhode/core/error.hpp"

namespace polhode {

void require_fixed_body(const Scene& scene, const std::vector<SceneParameter>& parameters) {
  if (!scene.rotors().empty() || scene.damper())
    throw InvalidInput("sensitivity", "of a body without rotors and damper where it changes", "one with them");
  using Of = SceneParameter::Of;
  for (const SceneParameter& parameter : parameters) {
    if (parameter.of == Of::omega || parameter.of == Of::attitude || parameter.of == Of::state ||
        parameter.of == Of::torque)
      continue;
    throw InvalidInput("sensitivity", "by the start or by numbers of torques where the body changes",
                       "'" + parameter.column + "'");
  }
}

void find_scaled(const Scene& scene, const Piece& piece, std::size_t number, ColumnCause& cause) {
  const auto at = std::find(piece.numbers.begin(), piece.numbers.end(), number);
  const LastingTorque given = drop_windows(scene.torques()[number]),
                      own = drop_windows(piece.torques[static_cast<std::size_t>(at - piece.numbers.begin())]);
  const auto* scaled = std::get_if<torques::Formula>(&own);
  if (scaled == nullptr) return;
  if (!std::holds_alternative<torques::Formula>(given)) {   // a formula has the inputs that it had
    const std::string_view name = std::visit([](const auto& one) -> const TorqueRecord& { return one.record(); },
                                             given).parameters[static_cast<std::size_t>(cause.field)].name;
    cause.field = find_field(*scaled, name);
  }
  cause.torque = own;
}

}  // namespace polhode
