#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "polhode/method/trajectory.hpp"

namespace polhode {

/// The order in which a run reaches the sample times: forward from the start, and backward from it.
struct SampleOrder {
  std::vector<std::size_t> forward, backward;

  SampleOrder(const std::vector<double>& times, double t0) {
    forward.reserve(times.size());
    for (std::size_t i = 0; i < times.size(); ++i) (times[i] >= t0 ? forward : backward).push_back(i);
    const auto before = [&](std::size_t a, std::size_t b) { return times[a] < times[b]; };
    if (!std::is_sorted(forward.begin(), forward.end(), before))
      std::stable_sort(forward.begin(), forward.end(), before);
    std::stable_sort(backward.begin(), backward.end(),
                     [&](std::size_t a, std::size_t b) { return times[a] > times[b]; });
  }
};

/// Sets the times of a trajectory that has a row for each of `times`, and removes the rows that were not reached.
inline void drop_unreached(const std::vector<double>& times, const std::vector<unsigned char>& reached,
                           Trajectory& trajectory) {
  if (std::find(reached.begin(), reached.end(), 0) == reached.end()) {
    trajectory.t = times;
    return;
  }
  const bool omega = !trajectory.omega.empty(), attitude = !trajectory.attitude.empty();
  const auto states = static_cast<std::size_t>(trajectory.extra.count);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!reached[i]) continue;
    trajectory.t.push_back(times[i]);
    if (omega && kept != i) std::copy_n(trajectory.omega.data() + 3 * i, 3, trajectory.omega.data() + 3 * kept);
    if (attitude && kept != i)
      std::copy_n(trajectory.attitude.data() + 4 * i, 4, trajectory.attitude.data() + 4 * kept);
    if (states > 0 && kept != i)
      std::copy_n(trajectory.states.data() + states * i, states, trajectory.states.data() + states * kept);
    ++kept;
  }
  if (omega) trajectory.omega.resize(3 * kept);
  if (attitude) trajectory.attitude.resize(4 * kept);
  trajectory.states.resize(states * kept);
}

}  // namespace polhode
