#pragma once

#include <array>
#include <optional>
#include <vector>

#include "polhode/formula/tape.hpp"

namespace polhode::formula {

/// phase and rate of a node that is phase + rate * time.
std::optional<Wave> find_wave(const Graph& graph, int node);

/// Components of a vector as a sum of vectors that a tape can carry; nothing where it depends on more than the time,
/// or on the time in another way.
std::optional<std::vector<CarriedVector>> find_carried(const Graph& graph, const std::array<int, 3>& components);

}  // namespace polhode::formula
