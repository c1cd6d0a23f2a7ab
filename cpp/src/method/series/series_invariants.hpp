#pragma once

#include "method/series/series_terms.hpp"
#include "polhode/math/detail/double_double.hpp"
#include "polhode/scene/scene.hpp"

namespace polhode {

/// The invariants of a driven body, and a projection of the state on them. They are the energy, or Jacobi's integral
/// (energy less n L_z) under gravity's gradient, and L_z if no torque acts about the vertical. A free body with rotors
/// conserves |L| with L = I w + h, which needs no attitude. The p_psi of a symmetric
/// top needs no projection, because its derivative is exactly zero.
///
/// The projection is one Newton step of the rate variables towards the values at the start, with residuals in
/// double-double. Its metric preserves the relative accuracy of u and v, and does not change constant rates. Hairer,
/// Lubich & Wanner 2006, Geometric Numerical Integration, IV.4.
class SeriesInvariants {
 public:
  /// The vector that is integrated beside the rates.
  enum class Sees { nothing, vertical, attitude };

  SeriesInvariants() = default;   ///< no invariants
  /// @param I_P, moment_P  principal moments; the sum of weight times arm
  /// @param h_P            the momentum of the rotors
  /// @param half_over_k    w1 = (v - u) / 2k of separatrix variables
  SeriesInvariants(const Scene& scene, const SeriesTerms& terms, const Vector3d& I_P, const Vector3d& moment_P,
                   const Vector3d& h_P, int gradients, double orbit_phase, const math::DD& half_over_k, Sees sees);

  /// Sets the values to restore from this state.
  void start(double t0, const double* y, const double* carry);
  bool any() const { return first_ || second_; }
  /// Corrects the rates of a state at time t.
  void restore(math::DD t, double* y, double* carry) const;

 private:
  struct Values;
  Values compute(math::DD t, const double* y, const double* carry) const;

  bool first_ = false, second_ = false;   ///< energy or Jacobi's integral; L_z, or |L|^2 / 2
  bool momentum_ = false;                 ///< the second is |L|^2 / 2
  bool separatrix_ = false, alone_[3] = {};   ///< a rate with zero derivative
  Sees sees_ = Sees::nothing;
  // In units of the body's own inertia and rate.
  double I_[3] = {}, moment_[3] = {}, h_[3] = {}, tidal_ = 0.0, orbit_rate_ = 0.0, orbit_phase_ = 0.0;
  double slow_ = 1.0, orbit_ = 0.0;       ///< rates times slow_ are near 1; orbit_rate_ times slow_
  double exchanged_ = 0.0;                ///< size of the potential energy
  math::DD half_over_k_, kept_[2];
};

}  // namespace polhode
