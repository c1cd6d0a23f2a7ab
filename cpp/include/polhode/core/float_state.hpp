#pragma once

#include <string_view>

#include "polhode/core/detail/float_flags.hpp"

namespace polhode {

/// Whether the processor takes numbers below 2.2e-308 for 0 on this thread. The start-up code of a library that was
/// linked with -ffast-math switches this on for the whole process.
bool flushes_to_zero();

/// Whether the processor rounds to nearest on this thread, as it does unless fesetround() or the like was called.
bool rounds_to_nearest();

/// Throws InvalidInput for a denormal number where the processor takes it for 0.
void require_kept(double value, std::string_view where);

}  // namespace polhode
