#pragma once

#include <algorithm>

#include "polhode/core/interrupt.hpp"
#include "polhode/core/state.hpp"
#include "polhode/exact/detail/time_grid.hpp"

namespace polhode::exact {

/// Calls use(part of the times, index of its first) for parts that take about a millisecond. The bits do not depend on
/// the parts, which are whole blocks of the grid. Ctrl-C is noticed between them.
template <class Use>
void each_part(const TimeGrid& times, const Use& use) {
  constexpr std::size_t most = 128 * TimeGrid::block;
  for (std::size_t begin = 0; begin < times.n; begin += most) {
    if (begin > 0) check_interrupt();
    use(times.piece(begin, std::min(most, times.n - begin)), begin);
  }
}

/// The state of a closed form at one time.
template <class Form>
State find_state(const Form& form, double t) {
  State state;
  state.t = t;
  double q[4];
  form.at(&t, 1, state.omega.data(), q);
  state.attitude = {q[0], q[1], q[2], q[3]};
  return state;
}

}  // namespace polhode::exact
