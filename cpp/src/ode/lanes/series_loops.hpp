#pragma once

#include "math/lanes/octet.hpp"
#include "polhode/ode/series.hpp"

namespace polhode::POLHODE_ISA {

/// Horner's rule in s^2 for the even and the odd powers: two chains of half the length. The first term, which dominates
/// the rounding error, is added last.
template <int points>
POLHODE_INLINE void evaluate_points(const double* rows, int order, int W, Octet base, Octet rest, const double* s,
                                    double* out) {
  Octet even[points], odd[points], s2[points];
  const int last_odd = (order - 1) / 2 * 2 + 1, last_even = order / 2 * 2;
  for (int p = 0; p < points; ++p) {
    s2[p] = all8(s[p] * s[p]);
    odd[p] = load8(rows + W * last_odd);
    even[p] = last_even >= 2 ? load8(rows + W * last_even) : all8(0.0);
  }
  for (int k = last_odd - 2; k >= 1; k -= 2) {
    const Octet row = load8(rows + W * k);
    for (int p = 0; p < points; ++p) odd[p] = madd(odd[p], s2[p], row);
  }
  for (int k = last_even - 2; k >= 2; k -= 2) {
    const Octet row = load8(rows + W * k);
    for (int p = 0; p < points; ++p) even[p] = madd(even[p], s2[p], row);
  }
  for (int p = 0; p < points; ++p) store8(out + W * p, base + madd(odd[p], all8(s[p]), madd(even[p], s2[p], rest)));
}

void evaluate(const double* rows, int order, int stride, const double* base, const double* rest, const double* s,
              std::size_t n, double* out) {
  const Octet first = load8(base), constant = load8(rest);
  const auto width = static_cast<std::size_t>(stride);
  std::size_t i = 0;
  for (; i + 4 <= n; i += 4) evaluate_points<4>(rows, order, stride, first, constant, s + i, out + width * i);
  for (; i < n; ++i) evaluate_points<1>(rows, order, stride, first, constant, s + i, out + width * i);
}

constexpr ode::SeriesKernels series_kernels{&evaluate};

}  // namespace polhode::POLHODE_ISA
