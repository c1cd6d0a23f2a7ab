#pragma once

#include "polhode/formula/program.hpp"

namespace polhode::formula {

/// What a torque's program does not use, and its degrees, by its structure alone. So a "no" is certain.
struct Facts {
  bool uses_time = false;
  bool uses_attitude = false;
  bool uses_rates = false;
  bool uses_states = false;        ///< states of its own
  bool has_switches = false;
  int degree = 0;                  ///< as a polynomial in all states, the time in its coefficients; -1: none
  int rate_degree = 0;             ///< in the rates alone; -1: no polynomial
  bool is_linear_in_rates() const { return rate_degree == 0 || rate_degree == 1; }
};

Facts find_facts(const Program& torque);

}  // namespace polhode::formula
