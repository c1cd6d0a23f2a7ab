#pragma once

#include "polhode/math/detail/double_double.hpp"

/// Jacobi's elliptic functions on the complementary pair (m, m1), m = k^2, m1 = 1 - m: near m = 1 the difference
/// 1 - m in floating point has no digits left, so both are given and the smaller one is taken as exact.
namespace polhode::elliptic {

struct Jacobi {
  double sn, cn, dn;
};

/// One parameter, its constants computed once in double-double.
class Parameter {
 public:
  /// m, m1 in [0, 1] with m + m1 = 1 to rounding; throws InvalidInput otherwise.
  Parameter(double m, double m1);

  double K() const { return K_.hi; }       ///< complete integral of the first kind; infinite for m1 = 0
  double nome() const { return nome_; }    ///< q = exp(-pi K(m1) / K(m)); 1 for m1 = 0

  /// sn, cn, dn of u, each within 4 units in the last place of its value, beyond 1e-30 |u| in the argument.
  /// |u| <= 1e15 K, or InvalidInput.
  Jacobi jacobi(double u) const;

 private:
  using DD = math::DD;

  Jacobi from_cycles(DD z) const;
  Jacobi from_exponential(DD v, double sign) const;

  bool hyper_ = false;     ///< m1 < 0.03: by the nome of m1 and exponentials, else by the nome of m and sines
  DD K_, q_, v_rate_, v_K_;
  DD sn_factor_, cn_factor_, dn_factor_;
  double nome_ = 0.0, m_ = 0.0;
};

Jacobi jacobi(double u, double m, double m1);
double K(double m, double m1);
double nome(double m, double m1);

}  // namespace polhode::elliptic
