#pragma once

#include <functional>

namespace polhode::ode {

/// The first zero of p(u) = sum of a_k u^k in (0, 1], where p(0) > 0, or p(0) = 0 and p is positive just behind it.
/// Intervals in which bounds of p exclude a zero are left out, others are halved, down to 1/2048.
/// @param degree  up to most_series_order
/// @return a number above 1 where there is none
double find_first_root(const double* a, int degree);

/// Where p without a zero in (0, 1] is lowest, if it comes below a limit there; not at 0 where p(0) = 0.
/// @return a number above 1 where it stays above the limit
double find_lowest(const double* a, int degree, double limit);

/// The first zero of a function next to a zero of its polynomial, by Newton's rule in a bracket.
/// @return the least number found where the function is not positive; above 1 where it is positive up to 1
double polish_root(const std::function<double(double)>& value, const double* a, int degree, double root);

}  // namespace polhode::ode
