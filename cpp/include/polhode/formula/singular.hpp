#pragma once

#include <string>

#include "polhode/formula/program.hpp"

namespace polhode::formula {

/// In words the operation without derivatives at a state, as "the root of omega.x": a division by 0, and a root, a
/// logarithm or a power of 0. "" if there is none.
/// @param near  how close to 0 an operand counts as 0
std::string find_singular(const Program& program, double t, const double* y, double near);

}  // namespace polhode::formula
