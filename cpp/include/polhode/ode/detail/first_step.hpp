#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "polhode/math/detail/functions.hpp"
#include "polhode/ode/problem.hpp"

namespace polhode::ode {

/// The shortest first step that the spacing of the times resolves. Very small rates, far from t = 0, suggest shorter.
inline double shortest_first_step(double t) { return 64 * std::numeric_limits<double>::epsilon() * std::abs(t); }

/// The first step of a method of this order, from the size of y' and y''. After Hairer, Norsett, Wanner 1993, Solving
/// ODEs I, sec. II.4, but independent of the unit of time: all is measured against tau, the time in which y changes by
/// its own size. f: y' at the start; `compute(t, y, f)`: the problem's derivative, wrapped so that calls are counted.
template <Problem P, class Compute>
double choose_first_step(const P& problem, const Tolerances& tolerances, int order, double t, const double* y,
                         const double* f, double t_end, const Compute& compute) {
  constexpr int N = P::dimension;
  const double span = std::abs(t_end - t), direction = t_end < t ? -1.0 : 1.0;
  if (span == 0.0) return 0.0;
  const auto norm_of = [&](const double* v, const double* y1) {
    return problem.error_norm(v, y, y1, tolerances.rtol, tolerances.atol);
  };
  const double d0 = norm_of(y, y), d1 = norm_of(f, y);
  if (d1 == 0.0) return direction * span;
  const double tau = d0 > 0 && std::isfinite(d1) ? std::min(d0 / d1, span) : 0.1 * span;
  const double h0 = 0.01 * tau;
  double y1[N], f1[N], change[N];
  for (int i = 0; i < N; ++i) y1[i] = y[i] + direction * h0 * f[i];
  compute(t + direction * h0, y1, f1);
  for (int i = 0; i < N; ++i) change[i] = (f1[i] - f[i]) / h0;
  const double d2 = norm_of(change, y1);
  const double size = std::max(d0, d2 * tau * tau);
  const double h1 = std::isfinite(size) && size > 0 ? tau * math::fast_pow(0.01 / size, 1.0 / order) : h0;
  return direction * std::min(std::max(std::min(100 * h0, h1), shortest_first_step(t)), span);
}

}  // namespace polhode::ode
