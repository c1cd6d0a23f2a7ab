#include "method/series/series_invariants.hpp"

#include <algorithm>
#include <cmath>

#include "polhode/math/detail/functions.hpp"

namespace polhode {

using math::DD;

/// The two invariants of a state, and their gradients by the rates.
struct SeriesInvariants::Values {
  DD kept[2];
  double slope[2][3];
  double moving;   ///< twice the kinetic energy in the frame in which the first invariant is the energy
};

SeriesInvariants::SeriesInvariants(const Scene& scene, const SeriesTerms& terms, const Vector3d& I_P,
                                   const Vector3d& moment_P, const Vector3d& h_P, int gradients, double orbit_phase,
                                   const DD& half_over_k, Sees sees)
    : separatrix_(terms.variables == RateVariables::separatrix),
      sees_(sees),
      orbit_phase_(orbit_phase),
      half_over_k_(half_over_k) {
  const TorqueSum& sum = scene.torque_sum();
  momentum_ = sum.rotors && sum.acting == 1;
  if (sum.acting == 0 || (sees == Sees::nothing && !momentum_)) return;
  const bool jacobi = sum.has_potential && !sum.keeps_energy && sum.keeps_jacobi && sees == Sees::attitude;
  first_ = (sum.has_potential && sum.keeps_energy) || jacobi;
  second_ = sum.keeps_vertical && sum.pattern_rate == 0.0;
  if (jacobi) orbit_rate_ = terms.orbit_rate;
  // Scaled by powers of two, because squares of 1e160 rad/s overflow.
  const double light = 1.0 / math::power_of_two_below(I_P.maxCoeff());
  const double fall = std::sqrt(light * moment_P.cwiseAbs().maxCoeff());
  const double rate = std::max({scene.omega().cwiseAbs().maxCoeff(), fall, std::abs(orbit_rate_),
                                light * h_P.cwiseAbs().maxCoeff()});
  if (!(rate > 0.0)) first_ = second_ = false;
  slow_ = 1.0 / math::power_of_two_below(rate);
  orbit_ = orbit_rate_ * slow_, tidal_ = 1.5 * gradients * orbit_ * orbit_;
  for (int i = 0; i < 3; ++i) {
    I_[i] = light * I_P[i], moment_[i] = light * moment_P[i] * slow_ * slow_;
    h_[i] = light * h_P[i] * slow_;
    alone_[i] = !separatrix_ && terms.product[i] == 0.0 && terms.torque[i] == 0.0;
    alone_[i] = alone_[i] && terms.tidal[0][i] == 0.0;
    for (const auto& column : terms.damping) alone_[i] = alone_[i] && column[i] == 0.0;
    for (const auto& vector : terms.pull)
      for (const auto& column : vector) alone_[i] = alone_[i] && column[i] == 0.0;
  }
}

void SeriesInvariants::start(double t0, const double* y, const double* carry) {
  if (!any()) return;
  const Values now = compute(t0, y, carry);
  kept_[0] = now.kept[0], kept_[1] = now.kept[1];
  const double heaviest = std::max({std::abs(moment_[0]), std::abs(moment_[1]), std::abs(moment_[2])});
  exchanged_ = std::max(heaviest, tidal_ * std::max({I_[0], I_[1], I_[2]}));
}

SeriesInvariants::Values SeriesInvariants::compute(DD t, const double* y, const double* carry) const {
  DD w[3];
  for (int i = 0; i < 3; ++i) w[i] = DD(slow_ * y[i], slow_ * carry[i]);
  if (separatrix_) {
    const DD u = w[0], v = w[1];
    w[1] = w[2], w[0] = (v - u) * half_over_k_, w[2] = (u + v) * DD(0.5);
  }
  DD g[3];
  Values values{};
  if (momentum_) {
    // In place of the vertical, L / 2: its product with L is |L|^2 / 2, whose gradient has twice its size.
    for (int i = 0; i < 3; ++i) g[i] = (w[i] * DD(I_[i]) + DD(h_[i])) * DD(0.5);
  } else if (sees_ == Sees::vertical) {
    for (int i = 0; i < 3; ++i) g[i] = DD(y[4 + i], carry[4 + i]);
  } else {
    DD q[4], two(2.0), norm(0.0);
    for (int i = 0; i < 4; ++i) q[i] = DD(y[4 + i], carry[4 + i]), norm = norm + q[i] * q[i];
    const DD scale = two / norm;
    g[0] = (q[0] * q[2] - q[3] * q[1]) * scale, g[1] = (q[1] * q[2] + q[3] * q[0]) * scale;
    g[2] = DD(1.0) - (q[0] * q[0] + q[1] * q[1]) * scale;
    if (tidal_ != 0.0) {
      // R^T (cos nt, sin nt, 0), from the first two rows of R.
      const DD product = math::two_prod(orbit_rate_, t.hi), angle = math::two_sum(product.hi, orbit_phase_);
      const double low = angle.lo + product.lo + orbit_rate_ * t.lo;
      const auto [s0, c0] = math::sincos(angle.hi);
      const DD s = DD(s0, c0 * low), c = DD(c0, -s0 * low);
      const DD xx = q[0] * q[0], yy = q[1] * q[1], zz = q[2] * q[2], xy = q[0] * q[1], xz = q[0] * q[2],
               yz = q[1] * q[2];
      const DD xw = q[0] * q[3], yw = q[1] * q[3], zw = q[2] * q[3];
      const DD unity(1.0);
      const DD u[3] = {c * (unity - (yy + zz) * scale) + s * ((xy + zw) * scale),
                       c * ((xy - zw) * scale) + s * (unity - (xx + zz) * scale),
                       (c * (xz + yw) + s * (yz - xw)) * scale};
      for (int i = 0; i < 3; ++i) values.kept[0] = values.kept[0] + u[i] * u[i] * DD(I_[i]) * DD(tidal_);
    }
  }
  for (int i = 0; i < 3; ++i) {
    const DD own = w[i] * DD(I_[i]), L = own + DD(h_[i]);
    values.kept[0] = values.kept[0] + own * w[i] * DD(0.5) + g[i] * DD(moment_[i]);
    values.kept[1] = values.kept[1] + L * g[i];
    const double relative = w[i].hi - orbit_ * g[i].hi;
    values.slope[0][i] = I_[i] * relative, values.slope[1][i] = (momentum_ ? 2.0 : 1.0) * I_[i] * g[i].hi;
    values.moving += I_[i] * relative * relative;
  }
  if (orbit_ != 0.0) values.kept[0] = values.kept[0] - values.kept[1] * DD(orbit_);
  return values;
}

void SeriesInvariants::restore(DD t, double* y, double* carry) const {
  const Values now = compute(t, y, carry);
  double slope[2][3], metric[3];
  for (int k = 0; k < 2; ++k) {
    const double* s = now.slope[k];
    if (separatrix_) {
      const double across = half_over_k_.hi * s[0], along = 0.5 * s[2];
      slope[k][0] = along - across, slope[k][1] = along + across, slope[k][2] = s[1];
    } else {
      std::copy_n(s, 3, slope[k]);
    }
  }
  for (int i = 0; i < 3; ++i) {
    const double r = slow_ * y[i];
    metric[i] = separatrix_ ? r * r : alone_[i] ? 0.0 : 1.0 / I_[i];
  }
  const auto product = [&](const double* a, const double* b) {
    return a[0] * b[0] * metric[0] + a[1] * b[1] * metric[1] + a[2] * b[2] * metric[2];
  };
  const double aa = product(slope[0], slope[0]), ab = product(slope[0], slope[1]), bb = product(slope[1], slope[1]);
  const double da = (kept_[0] - now.kept[0]).hi, db = (kept_[1] - now.kept[1]).hi;
  // For a body nearly at rest the error of the energy is in its attitude, not in its rates.
  const bool first = first_ && now.moving > 0.05 * exchanged_ && aa > 0.0, second = second_ && bb > 0.0;
  double along = 0.0, across = 0.0;
  if (const double det = aa * bb - ab * ab; first && second && det > 1e-3 * aa * bb) {
    along = (da * bb - db * ab) / det, across = (aa * db - ab * da) / det;
  } else if (first) {
    along = da / aa;
  } else if (second) {
    across = db / bb;
  }
  double change[3], largest = 0.0, size = 0.0;
  for (int i = 0; i < 3; ++i) {
    change[i] = metric[i] * (along * slope[0][i] + across * slope[1][i]) / slow_;
    largest = std::max(largest, std::abs(change[i])), size = std::max(size, std::abs(y[i]));
  }
  if (!(largest < 0.1 * size)) return;
  for (int i = 0; i < 3; ++i) {
    const DD restored = math::two_sum(y[i], carry[i] + change[i]);
    y[i] = restored.hi, carry[i] = restored.lo;
  }
}

}  // namespace polhode
