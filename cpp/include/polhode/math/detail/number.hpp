#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include "polhode/core/detail/float_flags.hpp"

// The closed forms are templates over a number type N. `double` is one; vectors of 4 or 8 doubles, each in its own
// namespace, and double-doubles over any of these are others. Such code may use + - * /, comparisons, and the few
// functions below, which every number type overloads; it may not branch on a number.

/// Kernels must be inlined: an out-of-line copy made in a file built for one instruction set must never be called
/// from a file built for another.
#if defined(__GNUC__) || defined(__clang__)
#define POLHODE_INLINE inline __attribute__((always_inline))
#else
#define POLHODE_INLINE inline
#endif

namespace polhode::math {

POLHODE_INLINE double fma(double a, double b, double c) { return std::fma(a, b, c); }  ///< a b + c, rounded once

/// a b + c, rounded once where the machine can, else twice: without the instruction std::fma is a slow call.
POLHODE_INLINE double madd(double a, double b, double c) {
#ifdef __FMA__
  return std::fma(a, b, c);
#else
  return a * b + c;
#endif
}

/// The nearest integer, ties to even.
POLHODE_INLINE double rint(double a) {
#ifdef __SSE4_1__
  return std::rint(a);
#else
  const double magic = std::copysign(0x1p52, a);  // adding it leaves no fraction; beyond it there is none
  return std::fabs(a) < 0x1p52 ? (a + magic) - magic : a;
#endif
}

POLHODE_INLINE double sqrt(double a) { return std::sqrt(a); }
POLHODE_INLINE double abs(double a) { return std::fabs(a); }
POLHODE_INLINE double copysign(double size, double sign) { return std::copysign(size, sign); }
POLHODE_INLINE double select(bool mask, double a, double b) { return mask ? a : b; }

/// 2^n for an integer n in [-1022, 1023].
POLHODE_INLINE double power_of_two(double n) {
  return std::bit_cast<double>(static_cast<std::int64_t>(n + 1023.0) << 52);
}

/// 2^floor(log2 |a|), not below 2^-1022.
POLHODE_INLINE double power_of_two_below(double a) {
  const double p = std::bit_cast<double>(std::bit_cast<std::uint64_t>(a) & 0x7ff0000000000000u);
  return p < 0x1p-1022 ? 0x1p-1022 : p;
}

/// n of a power of two 2^n, -1022 <= n <= 1023.
POLHODE_INLINE double exponent_of_power(double power) {
  return static_cast<double>(std::bit_cast<std::uint64_t>(power) >> 52) - 1023.0;
}

/// sine and cosine of a + r for the sine and cosine of r. a is `turns` in quarter turns, less 1.5 * 2^50: the last two
/// bits of `turns` say which.
POLHODE_INLINE void add_quarters(double turns, double sin_r, double cos_r, double& sine, double& cosine) {
  const auto quarters = std::bit_cast<std::uint64_t>(turns);
  const bool odd = quarters & 1;
  const auto change_sign = [](double x, std::uint64_t bit) {
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(x) ^ bit << 63);
  };
  sine = change_sign(odd ? cos_r : sin_r, quarters >> 1 & 1);
  cosine = change_sign(odd ? sin_r : cos_r, (quarters >> 1 ^ quarters) & 1);
}

/// 1 / sqrt(a) within 3.5 %, from the bits of a normal number a > 0.
POLHODE_INLINE double guess_inverse_sqrt(double a) {
  return std::bit_cast<double>(0x5fe6eb50c7b537a9u - (std::bit_cast<std::uint64_t>(a) >> 1));
}

POLHODE_INLINE bool any(bool mask) { return mask; }

template <class N>
POLHODE_INLINE N min(N a, N b) {
  return select(b < a, b, a);
}

template <class N>
POLHODE_INLINE N max(N a, N b) {
  return select(a < b, b, a);
}

/// What comparing two numbers gives: bool, or one bool a lane.
template <class N>
using Mask = decltype(N{} < N{});

/// 1 / sqrt(a) of a normal number a > 0, within 1.2 units of rounding. With fused steps it needs no divider: a guess, two
/// steps of third order and one of Newton's (P. Markstein, "IA-64 and Elementary Functions" (2000), chapter 9).
template <class N>
POLHODE_INLINE N inverse_sqrt(N a) {
#ifndef __FMA__
  return N(1.0) / sqrt(a);
#else
  N y = guess_inverse_sqrt(a);
  for (int i = 0; i < 2; ++i) {
    const N rest = madd(-(a * y), y, N(1.0));
    y = madd(y * rest, madd(N(0.375), rest, N(0.5)), y);
  }
  return madd(y * N(0.5), madd(-(a * y), y, N(1.0)), y);
#endif
}

/// c[0] + c[1] x + c[2] x^2 + ... With fused steps by Estrin's rule, in pairs that need not wait for one another; else
/// by Horner's, which the compiler turns into SSE2 vectors.
template <class C, class N, int n>
POLHODE_INLINE N polynomial(const C (&c)[n], N x) {
#ifndef __FMA__
  N sum = N(c[n - 1]);
  for (int i = n - 2; i >= 0; --i) sum = madd(sum, x, N(c[i]));
  return sum;
#else
  N term[(n + 1) / 2];
  int count = 0;
  for (int i = 0; i + 1 < n; i += 2) term[count++] = madd(N(c[i + 1]), x, N(c[i]));
  if (n % 2 == 1) term[count++] = N(c[n - 1]);
  for (N power = x * x; count > 1; power = power * power) {
    int kept = 0;
    for (int i = 0; i + 1 < count; i += 2) term[kept++] = madd(term[i + 1], power, term[i]);
    if (count % 2 == 1) term[kept++] = term[count - 1];
    count = kept;
  }
  return term[0];
#endif
}

}  // namespace polhode::math
