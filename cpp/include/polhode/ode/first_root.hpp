#pragma once

namespace polhode::ode {

/// The first zero of p(u) = sum of a_k u^k in (0, 1], where p(0) > 0, or p(0) = 0 and p is positive just behind it.
/// Intervals in which bounds of p exclude a zero are left out, others are halved, down to 1/2048.
/// @param degree  up to most_series_order
/// @return a number above 1 where there is none
double find_first_root(const double* a, int degree);

}  // namespace polhode::ode
