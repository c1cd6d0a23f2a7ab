#pragma once

#include <vector>

#include "polhode/formula/program.hpp"

namespace polhode::formula {

/// Which branch each switch of a program takes, in the order of the nodes: true where its guard is above 0.
using Mode = std::vector<bool>;

/// The switches that the outputs need.
std::vector<int> list_switches(const Program& program);

/// The guards of the switches, in their order; their signs decide the mode.
std::vector<Form> list_guards(const Program& program);

/// The mode at a state. Parameters must be bound.
Mode find_mode(const Program& program, double t, const double* y);

/// The program of one mode: each switch is replaced by its branch, which is continued beyond the surface. With guards
/// they follow the outputs, in the order of list_switches(). A guard of a switch in a branch that is not taken is kept.
Program in_mode(const Program& program, const Mode& mode, bool with_guards = false);

}  // namespace polhode::formula
