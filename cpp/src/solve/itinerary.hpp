#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace polhode {

/// The order in which the times are met: those at or after the start forwards, the others backwards.
struct Itinerary {
  std::vector<std::size_t> forward, backward;

  Itinerary(const std::vector<double>& times, double t0) {
    forward.reserve(times.size());
    for (std::size_t i = 0; i < times.size(); ++i) (times[i] >= t0 ? forward : backward).push_back(i);
    const auto before = [&](std::size_t a, std::size_t b) { return times[a] < times[b]; };
    if (!std::is_sorted(forward.begin(), forward.end(), before))
      std::stable_sort(forward.begin(), forward.end(), before);
    std::stable_sort(backward.begin(), backward.end(),
                     [&](std::size_t a, std::size_t b) { return times[a] > times[b]; });
  }
};

}  // namespace polhode
