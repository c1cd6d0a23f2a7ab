#pragma once

#include <cmath>

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
POLHODE_INLINE double rint(double a) { return std::rint(a); }                          ///< nearest integer, ties to even
POLHODE_INLINE double sqrt(double a) { return std::sqrt(a); }
POLHODE_INLINE double abs(double a) { return std::fabs(a); }
POLHODE_INLINE double copysign(double size, double sign) { return std::copysign(size, sign); }
POLHODE_INLINE double select(bool mask, double a, double b) { return mask ? a : b; }
POLHODE_INLINE bool any(bool mask) { return mask; }

template <class N>
POLHODE_INLINE N max(N a, N b) {
  return select(a < b, b, a);
}

/// What comparing two numbers gives: bool, or one bool a lane.
template <class N>
using Mask = decltype(N{} < N{});

/// c[0] + c[1] x + c[2] x^2 + ..., by Horner's rule with fused steps.
template <class N, int n>
POLHODE_INLINE N polynomial(const double (&c)[n], N x) {
  N sum = N(c[n - 1]);
  for (int i = n - 2; i >= 0; --i) sum = fma(sum, x, N(c[i]));
  return sum;
}

}  // namespace polhode::math
