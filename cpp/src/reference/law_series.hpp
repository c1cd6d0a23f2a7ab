#pragma once

#include <vector>

#include "polhode/formula/program.hpp"

namespace polhode {

/// The Taylor series of a law's torque in long double, from those of the body's state. Its parameters are not rounded
/// together.
class LawSeries {
 public:
  using Real = long double;
  using Series = std::vector<Real>;

  /// @param law  with the values of its parameters. @throws InvalidInput for switches and states of its own
  LawSeries(const formula::Program& law, int order);

  /// Coefficients n of the torque, from those up to n of the states.
  /// @param states  w_B and q_WB, seven series
  void expand(Real t, int n, const Series* const* states, Real* tau);

 private:
  void expand_ephemerides(Real t);
  Real sum(const formula::Form& form, int n) const;
  Real compute(int node, Real t, int n, const Series* const* states);
  Series& series(int node) { return series_[static_cast<std::size_t>(node)]; }
  const Series& series(int node) const { return series_[static_cast<std::size_t>(node)]; }

  formula::Program law_;
  std::vector<double> parameters_;
  int order_;
  std::vector<std::vector<double>> ephemerides_;   ///< rows of each
  std::vector<int> live_;
  std::vector<bool> fixed_;        ///< the same at all times
  std::vector<Series> series_;     ///< of the nodes
  std::vector<Series> partners_;   ///< cosine of a sine and the other way; 1 - z^2 of a tanh; x^2 + y^2 of an angle
};

/// sin and cos from double-double: those of the system's library differ between processors.
struct SinCosReal {
  long double sin, cos;
};
SinCosReal compute_sincos(long double angle);

}  // namespace polhode
