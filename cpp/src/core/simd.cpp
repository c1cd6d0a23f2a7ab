#include "polhode/core/simd.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "core/choose_once.hpp"
#include "polhode/core/error.hpp"

#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
#include <cpuid.h>
#define POLHODE_HAS_CPUID
#endif

namespace polhode {
namespace {

constexpr SimdLevel levels[] = {SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512};

// By the instruction itself: `__builtin_cpu_supports` of Zig's Clang always answers no. Bits and masks: Intel 64 and
// IA-32 Architectures Software Developer's Manual, volume 1, 14.3 and 15.2.
SimdLevel of_machine() {
#ifdef POLHODE_HAS_CPUID
  unsigned a = 0, b = 0, c = 0, d = 0;
  constexpr unsigned saves_state = 1u << 27, fma = 1u << 12;
  if (__get_cpuid(1, &a, &b, &c, &d) == 0 || (c & saves_state) == 0 || (c & fma) == 0) return SimdLevel::baseline;

  unsigned saved = 0, upper = 0;   // the registers that the operating system keeps for each thread
  __asm__ volatile("xgetbv" : "=a"(saved), "=d"(upper) : "c"(0));
  const auto keeps = [saved](unsigned mask) { return (saved & mask) == mask; };

  constexpr unsigned avx2 = 1u << 5, f = 1u << 16, dq = 1u << 17, vl = 1u << 31;
  if (__get_cpuid_count(7, 0, &a, &b, &c, &d) == 0 || (b & avx2) == 0 || !keeps(0x06)) return SimdLevel::baseline;
  constexpr unsigned wide = f | dq | vl;
  return (b & wide) == wide && keeps(0xe6) ? SimdLevel::avx512 : SimdLevel::avx2;
#else
  return SimdLevel::baseline;
#endif
}

SimdLevel decide() {
  const char* cap = std::getenv("POLHODE_SIMD");
  if (cap == nullptr || *cap == '\0') return of_machine();
  for (const SimdLevel level : levels) {
    if (std::string_view(cap) == to_text(level)) return std::min(level, of_machine());
  }
  throw InvalidInput("POLHODE_SIMD", "baseline, avx2 or avx512", cap);
}

}  // namespace

const char* to_text(SimdLevel level) {
  constexpr const char* names[] = {"baseline", "avx2", "avx512"};
  return names[static_cast<int>(level)];
}

SimdLevel simd_level() {
  static constinit std::atomic<const SimdLevel*> chosen{nullptr};
  return choose_once(chosen, []() -> const SimdLevel& { return *std::find(levels, levels + 3, decide()); });
}

}  // namespace polhode
