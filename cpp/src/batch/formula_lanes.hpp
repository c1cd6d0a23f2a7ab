#pragma once

#include <memory>

#include "batch/lane_method.hpp"

namespace polhode {

/// One body under formulas, and torques of the list beside them, for the lanes of Taylor series.
std::unique_ptr<LaneProblem> make_formula_lane(const Scene& scene, const LaneProblem* before);

}  // namespace polhode
