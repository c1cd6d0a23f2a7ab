#include "math/quarter_turns.hpp"

#include <bit>
#include <cstdint>

namespace polhode::math {
namespace {

/// 64 zeros, then the bits of 2 / pi after the point.
constexpr std::uint32_t two_over_pi[] = {
    0x00000000u, 0x00000000u, 0xa2f9836eu, 0x4e441529u, 0xfc2757d1u, 0xf534ddc0u, 0xdb629599u, 0x3c439041u,
    0xfe5163abu, 0xdebbc561u, 0xb7246e3au, 0x424dd2e0u, 0x06492eeau, 0x09d1921cu, 0xfe1deb1cu, 0xb129a73eu,
    0xe88235f5u, 0x2ebb4484u, 0xe99c7026u, 0xb45f7e41u, 0x3991d639u, 0x835339f4u, 0x9c845f8bu, 0xbdf9283bu,
    0x1ff897ffu, 0xde05980fu, 0xef2f118bu, 0x5a0a6d1fu, 0x6d367ecfu, 0x27cb09b7u, 0x4f463f66u, 0x9e5fea2du,
    0x7527bac7u, 0xebe5f17bu, 0x3d0739f7u, 0x8a5292eau, 0x6bfb5fb1u, 0x1f8d5d08u, 0x56033046u, 0xfc7b6babu};

}  // namespace

/// Payne & Hanek 1983, ACM SIGNUM Newsletter 18, 19: of 2 / pi only the 192 bits count whose product with the angle is
/// neither a multiple of four quarters nor below 2^-137. The product is exact in integers.
QuarterTurns reduce_exactly(double angle) {
  const bool negative_angle = angle < 0.0;
  const auto bits = std::bit_cast<std::uint64_t>(abs(angle));
  const std::uint64_t mantissa = (bits & 0x000fffffffffffffu) | 0x0010000000000000u;
  const int exponent = static_cast<int>(bits >> 52) - 1075;   // |angle| = mantissa 2^exponent
  // Bit i after the point of 2 / pi gives multiples of 2^(exponent - i) quarters: those of 4 and more are left out.
  const auto first = static_cast<std::size_t>(exponent - 1 + 63);   // in the table
  constexpr int words = 6;
  std::uint64_t product[words] = {};   // modulo 4 quarters; 32 bits each, the highest first
  const std::uint64_t factor[2] = {mantissa & 0xffffffffu, mantissa >> 32};
  for (int i = 0; i < words; ++i) {
    const std::size_t begin = first + 32 * static_cast<std::size_t>(i), at = begin / 32, shift = begin % 32;
    const std::uint64_t pair = (std::uint64_t{two_over_pi[at]} << 32) | two_over_pi[at + 1];
    const std::uint64_t word = (pair << shift) >> 32;
    for (int k = 0; k < 2; ++k) {
      std::uint64_t carry = word * factor[k];
      for (int place = i - k; place >= 0; --place) {
        carry += product[place];
        product[place] = carry & 0xffffffffu;
        carry >>= 32;
      }
    }
  }
  // Two bits are quarters, the others a fraction, which is taken below 1/2 in size.
  auto quarters = static_cast<unsigned>(product[0] >> 30);
  const bool negative = (product[0] >> 29 & 1) != 0;
  product[0] &= 0x3fffffffu;
  quarters += negative;
  DD fraction(negative ? -1.0 : 0.0);
  double unit = 0x1p-30;
  for (int i = 0; i < words; ++i, unit *= 0x1p-32) fraction = fraction + DD(static_cast<double>(product[i]) * unit);
  const DD rest = fraction * DD(1.5707963267948966, 6.123233995736766e-17);
  return negative_angle ? QuarterTurns{-rest.hi, -rest.lo, (0u - quarters) & 3u}
                        : QuarterTurns{rest.hi, rest.lo, quarters & 3u};
}

}  // namespace polhode::math
