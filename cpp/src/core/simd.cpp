#include "polhode/core/simd.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "core/choose_once.hpp"
#include "polhode/core/error.hpp"

namespace polhode {
namespace {

constexpr SimdLevel levels[] = {SimdLevel::baseline, SimdLevel::avx2, SimdLevel::avx512};

SimdLevel of_machine() {
#if defined(__x86_64__) && (defined(__GNUC__) || defined(__clang__))
  __builtin_cpu_init();
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma")) return SimdLevel::baseline;
  const bool wide =
      __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
  return wide ? SimdLevel::avx512 : SimdLevel::avx2;
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
