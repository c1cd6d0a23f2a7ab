#pragma once

#include <vector>

#include "polhode/formula/program.hpp"
#include "polhode/math/detail/interval.hpp"

namespace polhode::proof {

/// The outputs of a program without switches over sets of its time, its states by their numbers, and its parameters. What
/// is not known to be finite is the whole line.
std::vector<math::Interval> evaluate(const formula::Program& program, const math::Interval& time,
                                     const std::vector<math::Interval>& states,
                                     const std::vector<math::Interval>& parameters);

}  // namespace polhode::proof
