#pragma once

#include <string>
#include <utility>
#include <vector>

#include "polhode/formula/program.hpp"

namespace polhode::formula {

/// A formula as text, the form of scene files.
///
///     torque = "-kp * attitude.xyz * attitude.w - kd * omega"
///
/// Names: t, omega, attitude, pi, the parameters, the states, and what `let` defined before. An orbit `main` has main.r,
/// main.v, main.distance and main.inverse_distance. Operators: + - * / ^ and
/// comparisons, elementwise on vectors. Components: .x .y .z .w .xyz and [a, b, c]. Functions: abs atan2 clip cos cross
/// dot exp hypot log max min norm sign sin sqrt sum tan tanh to_body to_space where. Exponents are numbers.
struct Text {
  std::string torque;                                      ///< empty where there is a potential
  std::vector<Input> parameters;
  std::vector<Input> states;
  std::vector<std::string> rates;                          ///< of the states
  std::vector<std::pair<std::string, std::string>> let;    ///< names for shared parts, in order
  std::string potential = {};                              ///< V [J], whose negative gradient is the torque
  std::vector<std::pair<std::string, Ephemeris>> orbits = {};   ///< by name, as `main` of main.r.x

  friend bool operator==(const Text&, const Text&) = default;
};

inline constexpr std::size_t most_characters = 10'000;
inline constexpr int most_depth = 100;

/// The program of a torque and its states, or of a potential alone, which has one output.
/// @throws InvalidInput with the field, line and column, what was found, and the known names
Program parse(const Text& text);

/// The text of a torque's program, or of a potential's. parse() makes an equal graph of it, with the same bits.
Text print(const Program& program);

}  // namespace polhode::formula
