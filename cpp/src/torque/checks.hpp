#pragma once

#include <cmath>
#include <string_view>

#include "polhode/core/error.hpp"
#include "polhode/core/float_state.hpp"

namespace polhode::torques {

inline void require_finite(std::string_view where, const double* values, int count) {
  for (int i = 0; i < count; ++i) {
    if (!std::isfinite(values[i])) throw InvalidInput(where, "finite", to_text(values[i]));
    require_kept(values[i], where);
  }
}

}  // namespace polhode::torques
