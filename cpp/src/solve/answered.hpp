#pragma once

#include <algorithm>
#include <vector>

#include "polhode/solve/motion.hpp"

namespace polhode {

/// Gives a motion that has a row for each of `times` its times, and leaves out the rows that were not answered.
inline void keep_answered(const std::vector<double>& times, const std::vector<unsigned char>& answered, Motion& motion) {
  if (std::find(answered.begin(), answered.end(), 0) == answered.end()) {
    motion.t = times;
    return;
  }
  const bool omega = !motion.omega.empty(), attitude = !motion.attitude.empty();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!answered[i]) continue;
    motion.t.push_back(times[i]);
    if (omega && kept != i) std::copy_n(motion.omega.data() + 3 * i, 3, motion.omega.data() + 3 * kept);
    if (attitude && kept != i) std::copy_n(motion.attitude.data() + 4 * i, 4, motion.attitude.data() + 4 * kept);
    ++kept;
  }
  if (omega) motion.omega.resize(3 * kept);
  if (attitude) motion.attitude.resize(4 * kept);
}

}  // namespace polhode
