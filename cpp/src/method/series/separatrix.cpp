#include "method/series/separatrix.hpp"

#include <algorithm>
#include <cmath>

namespace polhode {
namespace {

using math::DD;

/// Up to this ratio of k to 1 the variables suit every motion.
constexpr double widest_k = 8.0;

}  // namespace

Separatrix::Separatrix(const Vector3d& I_P) {
  // Scaled, so that products of two moments of 1e-120 or 1e120 kg m^2 do not leave the range of float64.
  const double scale = math::power_of_two_below(I_P[2]);
  const DD I1 = I_P[0] / scale, I2 = I_P[1] / scale, I3 = I_P[2] / scale;
  const DD lower = I2 - I1, upper = I3 - I2;
  k_ = math::sqrt((I1 * lower) / (I3 * upper));
  half_over_k_ = DD(0.5) / k_;
  rate_ = math::sqrt((lower * upper) / (I1 * I3));
  middle_ = (I3 - I1) / I2 * half_over_k_ * DD(0.5);
}

bool Separatrix::suits(const Vector3d& w) const {
  if (k_.hi > 1.0 / widest_k && k_.hi < widest_k) return true;
  // |u v| is near max(w3^2, (k w1)^2) if one of the two is much larger.
  double r[3], carry[3];
  from_rates(w.data(), r, carry);
  const double near = std::min(k_.hi, 1.0 / k_.hi);
  return std::abs(r[0] * r[1]) < near * near * w.squaredNorm();
}

void Separatrix::from_rates(const double* w, double* r, double* carry) const {
  const DD kw = k_ * DD(w[0]), u = DD(w[2]) - kw, v = DD(w[2]) + kw;
  r[0] = u.hi, r[1] = v.hi, r[2] = w[1];
  carry[0] = u.lo, carry[1] = v.lo, carry[2] = 0.0;
}

}  // namespace polhode
