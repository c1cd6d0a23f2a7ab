#pragma once

// The normal distribution with the same bits on every machine, as math/detail/functions.hpp.
namespace polhode::math {

/// The z >= 0 above which a standard normal variable lies with probability p, 1e-300 <= p <= 1/2. Within 2.5 ulp.
double upper_normal_quantile(double p);

/// The probability that a standard normal variable exceeds x, for any x; 0 for x > 37. Within 1 ulp. Some microseconds.
double upper_normal_tail(double x);

}  // namespace polhode::math
