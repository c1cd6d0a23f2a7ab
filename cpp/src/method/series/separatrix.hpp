#pragma once

#include "polhode/core/state.hpp"
#include "polhode/math/detail/double_double.hpp"

namespace polhode {

/// The rates of a body with principal moments I1 < I2 < I3 in variables that its separatrix is written in:
/// u = w3 - k w1, v = w3 + k w1 and w2, k^2 = I1 (I2 - I1) / (I3 (I3 - I2)). On the separatrix u or v is zero, and near
/// it each keeps its relative accuracy through every flip, where w1 and w3 shrink together: without torque
/// u' = rate w2 u, v' = -rate w2 v, w2' = middle (v - u)(v + u), rate^2 = (I2 - I1)(I3 - I2) / (I1 I3).
class Separatrix {
 public:
  explicit Separatrix(const Vector3d& I_P);

  /// Whether these variables serve a motion through w better than the plain rates: far from the separatrix they mix
  /// rates of two sizes where k is far from 1.
  bool suits(const Vector3d& w_P) const;

  const math::DD& k() const { return k_; }
  const math::DD& rate() const { return rate_; }
  const math::DD& middle() const { return middle_; }
  const math::DD& half_over_k() const { return half_over_k_; }   ///< w1 = (v - u) / 2k

  /// (u, v, w2) of rates, and what rounding took from them.
  void from_rates(const double* w_P, double* r, double* carry) const;
  /// The same of any vector, with k rounded: of a torque over the moments.
  void from_vector(const double* a, double* r) const {
    r[0] = a[2] - k_.hi * a[0], r[1] = a[2] + k_.hi * a[0], r[2] = a[1];
  }
  void to_rates(const double* r, double* w_P) const {
    w_P[0] = (r[1] - r[0]) * half_over_k_.hi, w_P[1] = r[2], w_P[2] = (r[0] + r[1]) * 0.5;
  }

 private:
  math::DD k_, half_over_k_, rate_, middle_;
};

}  // namespace polhode
