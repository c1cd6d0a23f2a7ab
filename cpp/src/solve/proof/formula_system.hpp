#pragma once

#include <vector>

#include "polhode/formula/program.hpp"
#include "solve/proof/body_constants.hpp"

namespace polhode::proof {

/// Equations y' = f(t, y) as a program without roundings: see ExactGraph. They may have switches.
struct FormulaEquations {
  int size;   ///< variables: the rates, the attitude where it is needed, the formulas' own states
  formula::Program program;        ///< the outputs are f
  std::vector<Interval> values;    ///< of its parameters
  double t0, per_time;             ///< the program's time is t0 + per_time * (time since the start) [s]
  bool has_attitude;

  /// Which variable a state of the program is.
  int find_variable(int state) const {
    return state < formula::first_extra ? state : state - formula::first_extra + first_own();
  }
  /// The first of the formulas' own states.
  int first_own() const { return has_attitude ? formula::first_extra : formula::first_attitude; }
};

/// The same without switches, or in one mode of them.
struct FormulaSystem : FormulaEquations {
  formula::Program derivatives = {};   ///< f, df by the first variable, by the second and so on, then the guards
  int guards = 0;
  /// f; and where there are guards these, their derivatives by the first variable, by the second and so on, and by time.
  formula::Program surface = {};
};

/// @param smooth  f and then guards, as a program of the equations without switches
FormulaSystem differentiate(const FormulaEquations& equations, const formula::Program& smooth);

/// The units of a body's equations and the direction of time.
struct Units {
  double rate;   ///< of the variables of w_B [rad/s], a power of two
  double pace;   ///< of 1 / time [1/s], a power of two
  double sign;   ///< -1 backwards in time
  const std::vector<double>& states;   ///< of the formulas' own states, powers of two
};

/// Whether a scene's proof is by formulas: one of its torques is known in no other form.
bool needs_formula_system(const std::vector<AnyTorque>& torques);

/// A body under torques without windows, and rotors.
FormulaEquations make_formula_equations(const Scene& scene, const std::vector<AnyTorque>& torques,
                                  const std::vector<bool>& rotating, const Units& units, bool has_attitude);

}  // namespace polhode::proof
