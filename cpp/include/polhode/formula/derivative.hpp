#pragma once

#include <vector>

#include "polhode/formula/program.hpp"

namespace polhode::formula {

/// What a program is differentiated by.
struct Variable {
  enum class Kind {
    state,
    parameter,
    time,
    rotation   ///< a small rotation about body axis 0, 1 or 2: q exp(e a / 2), at a = 0
  };
  Kind kind;
  int number;
};

/// A program with derivatives, made once by symbols; common parts are shared.
///
/// The outputs of the given program come first, then all their derivatives by the first variable, and so on. A switch
/// keeps its guard: inside each branch the derivative is that of the branch.
Program differentiate(const Program& program, const std::vector<Variable>& variables);

/// The torque tau_i = -dV(q exp(e_i a / 2))/da at a = 0 of a potential V, in body axes.
/// @throws InvalidInput for a potential that depends on the rates
Program derive_torque(const Program& potential);

}  // namespace polhode::formula
