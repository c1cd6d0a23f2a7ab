#pragma once

#include <vector>

#include "polhode/formula/program.hpp"

namespace polhode::formula {

/// Where a guard is, or a friction that holds its rate at 0.
enum class Side : signed char { below = -1, held = 0, above = 1 };

/// The guards of a program's switches in the order of the nodes. Switches of the same surface share one, as those of x
/// and of -2 x, up to rounding.
struct Guards {
  std::vector<Form> forms;
  std::vector<bool> holds;   ///< whether friction may hold it
  std::vector<int> nodes;    ///< of each, that of a guard

  struct Place {
    std::size_t number;   ///< behind the last one where there is none
    bool negated;         ///< the switch's guard is negative where this one is positive
  };
  /// That of a switch, by the node of its guard.
  Place find(const Graph& graph, int node) const;
};
Guards list_sided_guards(const Program& program);

/// A guard that acts in one mode, or a limit of friction that holds.
struct ActiveGuard {
  int number;           ///< among all guards
  Side edge = Side::held;   ///< held: the guard itself; else 1 - s or 1 + s of the share s of the friction's load
};

/// The program of one mode. Its extras are the guards that the mode needs.
struct ModeProgram {
  Program program;
  std::vector<ActiveGuard> guards;
};

/// Each switch becomes its branch, which is continued beyond the surface. Friction that holds becomes the share of its
/// load that keeps the rate constant.
/// @param system  outputs are the rates of all its states, then further ones
/// @throws InvalidInput where no share of the load can hold the rates
ModeProgram make_mode(const Program& system, const std::vector<Side>& sides, std::size_t further = 0);

}  // namespace polhode::formula
