#pragma once

#include <map>
#include <memory>
#include <vector>

#include "polhode/formula/sides.hpp"

namespace polhode {

struct ColumnEquations;

/// The equations of formulas, by the sides of their switches.
using ModeEquations = std::map<std::vector<formula::Side>, std::shared_ptr<const ColumnEquations>>;

}  // namespace polhode
