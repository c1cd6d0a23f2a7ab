#pragma once

#include "polhode/torque/formula.hpp"

namespace polhode {

/// @throws InvalidInput for a motor's formula that is not one number
void require_motor(const formula::Text& law);

}  // namespace polhode
