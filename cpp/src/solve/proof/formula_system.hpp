#pragma once

#include <vector>

#include "polhode/formula/program.hpp"
#include "solve/proof/body_constants.hpp"

namespace polhode::proof {

/// Equations y' = f(t, y) as a program without roundings: see ExactGraph.
struct FormulaSystem {
  int size;                        ///< variables: the rates, the attitude where it is needed, the formulas' own states
  formula::Program program;        ///< the outputs are f, then df by the first variable, by the second and so on
  std::vector<Interval> values;    ///< of its parameters
  double t0, per_time;             ///< the program's time is t0 + per_time * (time since the start) [s]
  bool has_attitude;

  /// Which variable a state of the program is.
  int find_variable(int state) const { return state < formula::first_extra ? state : state - formula::first_extra + first_own(); }
  /// The first of the formulas' own states.
  int first_own() const { return has_attitude ? formula::first_extra : formula::first_attitude; }
};

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
FormulaSystem make_formula_system(const Scene& scene, const std::vector<AnyTorque>& torques,
                                  const std::vector<bool>& rotating, const Units& units, bool has_attitude);

}  // namespace polhode::proof
