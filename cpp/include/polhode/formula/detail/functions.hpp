#pragma once

namespace polhode::formula {

/// tanh x and its derivative 1 / cosh^2 x, which has no cancellation where tanh x is near 1.
struct TanhPair {
  double value, slope;
};
TanhPair compute_tanh(double x);

/// e^x within 3e-16; 0 and infinity beyond float64's range.
double compute_exp(double x);

}  // namespace polhode::formula
