#pragma once

#include "polhode/core/simd.hpp"

namespace polhode {

/// What the first function gives that has something for a level: that of the level itself, then those below it. The
/// functions of the higher levels give null where their kernels are not compiled or do not take the arguments.
template <class Find, class... Arguments>
auto choose_level(SimdLevel level, Find* baseline, Find* avx2, Find* avx512, const Arguments&... arguments) {
  if (level == SimdLevel::avx512) {
    if (const auto found = avx512(arguments...)) return found;
  }
  if (level != SimdLevel::baseline) {
    if (const auto found = avx2(arguments...)) return found;
  }
  return baseline(arguments...);
}

}  // namespace polhode
