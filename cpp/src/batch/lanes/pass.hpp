#pragma once

#include "batch/lanes/lane_state.hpp"
#include "polhode/math/detail/number.hpp"

namespace polhode::POLHODE_ISA {

using Row = LaneState::Row;

/// One pass over a block: the lanes from `at` on, as many as a register holds.
struct Pass {
  int at;
  POLHODE_INLINE Wide load(const Row& row) const { return Wide::load(row + at); }
  POLHODE_INLINE void store(Row& row, Wide value) const { value.store(row + at); }
};

}  // namespace polhode::POLHODE_ISA
