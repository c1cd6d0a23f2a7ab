#pragma once

#include <array>
#include <cstdint>

#include "polhode/math/detail/number.hpp"

namespace polhode::math {

/// The product of two words: its high word, and its low word in `low`.
POLHODE_INLINE std::uint64_t wide_product(std::uint64_t a, std::uint64_t b, std::uint64_t& low) {
  low = a * b;
#if defined(__SIZEOF_INT128__)
  __extension__ typedef unsigned __int128 Wide128;
  return static_cast<std::uint64_t>((static_cast<Wide128>(a) * b) >> 64);
#else
  const std::uint64_t a0 = a & 0xffffffffu, a1 = a >> 32, b0 = b & 0xffffffffu, b1 = b >> 32;
  const std::uint64_t middle = a1 * b0 + ((a0 * b0) >> 32), other = a0 * b1 + (middle & 0xffffffffu);
  return a1 * b1 + (middle >> 32) + (other >> 32);
#endif
}

/// Four random words that depend on the counter and the key alone: Philox4x64-10 (Salmon, Moraes, Dror & Shaw 2011,
/// SC11, 16, section 3.4).
inline std::array<std::uint64_t, 4> philox(std::array<std::uint64_t, 4> c, std::array<std::uint64_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    std::uint64_t low0, low1;
    const std::uint64_t high0 = wide_product(0xd2e7470ee14c6c93u, c[0], low0);
    const std::uint64_t high1 = wide_product(0xca5a826395121157u, c[2], low1);
    c = {high1 ^ c[1] ^ key[0], low1, high0 ^ c[3] ^ key[1], low0};
    key[0] += 0x9e3779b97f4a7c15u, key[1] += 0xbb67ae8584caa73bu;
  }
  return c;
}

}  // namespace polhode::math
