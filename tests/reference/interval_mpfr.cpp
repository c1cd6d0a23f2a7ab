// Reads pairs of doubles and writes, for each, the bounds of their sum, difference, product, quotient, square, square
// root, sine, cosine, exponential, logarithm, hyperbolic tangent and angle: interval_mpfr.py compares them with MPFR.
#include <cstdio>
#include <vector>

#include "polhode/math/detail/interval_functions.hpp"

int main() {
  using namespace polhode::math;
  std::vector<double> out;
  double pair[2];
  while (std::fread(pair, sizeof(double), 2, stdin) == 2) {
    const Interval a(pair[0]), b(pair[1]);
    const IntervalSinCos trig = sincos(a);
    for (const Interval& found : {a + b, a - b, a * b, a / b, sqr(a), sqrt(a), trig.sin, trig.cos, exp(a), log(a),
                                  tanh(a), atan2(a, b)}) {
      out.push_back(found.middle.hi), out.push_back(found.middle.lo), out.push_back(found.radius);
      out.push_back(found.lower()), out.push_back(found.upper());
    }
  }
  std::fwrite(out.data(), sizeof(double), out.size(), stdout);
}
