#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace polhode {

/// Arguments up to here are reduced exactly enough by sincos below.
inline constexpr double kSinCosLimit = 0x1p20;

/// s[i] = sin x[i], c[i] = cos x[i] for |x| <= kSinCosLimit, within 0.8 ulp; a loop without branches, which compilers
/// turn into vector code (that of the C library is not).
/// x = n pi/2 + r + tail with pi/2 in three parts after Cody & Waite 1980 (the first two of 33 bits: n times them is
/// exact), then Taylor's polynomials on |r| <= pi/4, whose next terms are below 1e-18.
inline void sincos(std::size_t count, const double* __restrict x, double* __restrict s, double* __restrict c) {
  constexpr double kTwoOverPi = 0.6366197723675814;
  constexpr double kPart1 = 0x1.921fb544p+0, kPart2 = 0x1.0b4611a6p-34, kPart3 = 0x1.3198a2e037073p-69;
  constexpr double kRound = 0x1.8p52;  // adding it rounds to an integer, which stands in the low bits
  constexpr std::uint64_t kSignBit = 1ULL << 63;
  for (std::size_t i = 0; i < count; ++i) {
    const double shifted = x[i] * kTwoOverPi + kRound;
    const double n = shifted - kRound;
    const auto quadrant = std::bit_cast<std::uint64_t>(shifted);

    const double a = x[i] - n * kPart1, b = n * kPart2;
    const double r0 = a - b;
    const double z0 = a - r0, lost = (a - (r0 + z0)) + (z0 - b);  // a - b = r0 + lost exactly (Knuth's two-sum)
    const double rest = lost - n * kPart3;
    const double r = r0 + rest, tail = (r0 - r) + rest;

    const double z = r * r;
    double sine_sum = 1.0 / 355687428096000.0;  // 1/17!, then down to 1/3!
    sine_sum = -1.0 / 1307674368000.0 + z * sine_sum;
    sine_sum = 1.0 / 6227020800.0 + z * sine_sum;
    sine_sum = -1.0 / 39916800 + z * sine_sum;
    sine_sum = 1.0 / 362880 + z * sine_sum;
    sine_sum = -1.0 / 5040 + z * sine_sum;
    sine_sum = 1.0 / 120 + z * sine_sum;
    sine_sum = z * (-1.0 / 6 + z * sine_sum);
    double cosine_sum = 1.0 / 20922789888000.0;  // 1/16!, then down to 1/4!
    cosine_sum = -1.0 / 87178291200.0 + z * cosine_sum;
    cosine_sum = 1.0 / 479001600 + z * cosine_sum;
    cosine_sum = -1.0 / 3628800 + z * cosine_sum;
    cosine_sum = 1.0 / 40320 + z * cosine_sum;
    cosine_sum = -1.0 / 720 + z * cosine_sum;
    cosine_sum = z * z * (1.0 / 24 + z * cosine_sum);
    const double sine = r + (r * sine_sum + tail);
    const double half = 0.5 * z, top = 1.0 - half;
    const double cosine = top + (((1.0 - top) - half) + (cosine_sum - r * tail));

    // Odd quadrants swap the two; the sine is negative in 2 and 3, the cosine in 1 and 2.
    const std::uint64_t swap = 0 - (quadrant & 1);
    const auto bs = std::bit_cast<std::uint64_t>(sine), bc = std::bit_cast<std::uint64_t>(cosine);
    const std::uint64_t mixed = (bs ^ bc) & swap;
    s[i] = std::bit_cast<double>((bs ^ mixed) ^ ((quadrant << 62) & kSignBit));
    c[i] = std::bit_cast<double>((bc ^ mixed) ^ (((quadrant + 1) << 62) & kSignBit));
  }
}

}  // namespace polhode
