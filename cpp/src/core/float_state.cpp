#include "polhode/core/float_state.hpp"

#include <bit>
#include <cstdint>

#include "polhode/core/error.hpp"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace polhode {

bool flushes_to_zero() {
#if defined(__SSE2__)
  constexpr unsigned flush_results = 0x8000, inputs_are_zero = 0x0040;   // of the register MXCSR
  return (_mm_getcsr() & (flush_results | inputs_are_zero)) != 0;
#else
  const volatile double smallest_normal = 0x1p-1022;
  return smallest_normal * 0.5 == 0.0;
#endif
}

bool rounds_to_nearest() {
  // Sums show it, whichever register holds the mode: up, towards zero or down, one of them is another number.
  const volatile double one = 1.0, little = 0x1p-60;
  return one + little == 1.0 && one - little == 1.0 && -one + little == -1.0 && -one - little == -1.0;
}

void require_kept(double value, std::string_view where) {
  // Comparisons would take the number for 0, too.
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(value);
  const bool denormal = (bits >> 52 & 0x7ff) == 0 && bits << 12 != 0;
  if (!denormal || !flushes_to_zero()) return;
  throw InvalidInput(where, "0, or 2.2e-308 or more in size", "a number below",
                     "this thread takes such numbers for 0: a library that was linked with -ffast-math does that");
}

}  // namespace polhode
