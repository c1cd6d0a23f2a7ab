#pragma once

#include <string>
#include <vector>

#include "polhode/scene/scene.hpp"

namespace polhode {

/// Whether a formula that is no torque of the list becomes a compiled function, which is integrated as the user's own.
enum class AsCustom { no, yes };

/// The scene without the formulas that are torques of the list: each is replaced by them, if its user allows it. Other
/// torques keep their numbers in the list.
/// @param recognised  gets one sentence for each such formula, or null
Scene resolve_formulas(const Scene& scene, AsCustom as_custom, std::vector<std::string>* recognised = nullptr);

}  // namespace polhode
