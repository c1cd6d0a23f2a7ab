#pragma once

#include <string_view>

#include "polhode/core/detail/float_flags.hpp"

namespace polhode {

/// Whether the processor takes numbers below 2.2e-308 for 0 on this thread. The start-up code of a library that was
/// linked with -ffast-math switches this on for the whole process.
bool flushes_to_zero();

/// Throws InvalidInput for a denormal number where the processor takes it for 0.
void require_kept(double value, std::string_view where);

}  // namespace polhode
