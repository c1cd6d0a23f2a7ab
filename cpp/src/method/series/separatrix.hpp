#pragma once

#include "polhode/core/state.hpp"
#include "polhode/math/detail/double_double.hpp"

namespace polhode {

/// Separatrix variables for the rates of a body with principal moments I1 < I2 < I3. They are u = w3 - k w1, v = w3 + k
/// w1 and w2, with k^2 = I1 (I2 - I1) / (I3 (I3 - I2)). On the separatrix u or v is zero. Near it, each keeps its
/// relative accuracy through every flip, where w1 and w3 are small together. Without torque u' = rate w2 u, v' = -rate
/// w2 v, w2' = middle (v - u)(v + u), rate^2 = (I2 - I1)(I3 - I2) / (I1 I3).
class Separatrix {
 public:
  explicit Separatrix(const Vector3d& I_P);

  /// True if these variables suit a motion through w better than the plain rates. They do not if w is far from the
  /// separatrix and k far from 1, because they then mix rates of different sizes.
  bool suits(const Vector3d& w_P) const;

  const math::DD& k() const { return k_; }
  const math::DD& rate() const { return rate_; }
  const math::DD& middle() const { return middle_; }
  const math::DD& half_over_k() const { return half_over_k_; }   ///< w1 = (v - u) / 2k

  /// (u, v, w2) of rates, and their rounding errors.
  void from_rates(const double* w_P, double* r, double* carry) const;
  /// The same for any vector, such as a torque over the moments, with k rounded.
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
