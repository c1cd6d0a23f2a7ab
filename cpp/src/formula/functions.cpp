#include "polhode/formula/detail/functions.hpp"

#include <cmath>
#include <limits>

#include "polhode/math/detail/exp.hpp"
#include "polhode/math/detail/functions.hpp"

namespace polhode::formula {

TanhPair compute_tanh(double x) {
  const double size = std::abs(x);
  if (size < 0.35) {
    // sinh x / x and cosh x by their Taylor polynomials
    constexpr double odd[] = {1.0,          1.0 / 6,        1.0 / 120,       1.0 / 5040,
                              1.0 / 362880, 1.0 / 39916800, 1.0 / 6227020800};
    constexpr double even[] = {1.0, 1.0 / 2, 1.0 / 24, 1.0 / 720, 1.0 / 40320, 1.0 / 3628800, 1.0 / 479001600};
    const double square = x * x, cosh = math::polynomial(even, square);
    return {x * math::polynomial(odd, square) / cosh, 1.0 / (cosh * cosh)};
  }
  if (!(size < 350.0)) return {std::copysign(size == size ? 1.0 : x, x), size == size ? 0.0 : x};
  const double e = math::exp_minus(size + size), sum = 1.0 + e;
  return {std::copysign((1.0 - e) / sum, x), 4.0 * e / (sum * sum)};
}

double compute_exp(double x) {
  if (!(std::abs(x) < 700.0)) return math::exp(x);
  double minus, plus;
  math::exp_both(std::abs(x), minus, plus);
  return x < 0.0 ? minus : plus;
}

}  // namespace polhode::formula
