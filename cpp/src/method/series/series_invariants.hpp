#pragma once

#include "method/series/series_terms.hpp"
#include "polhode/math/detail/double_double.hpp"
#include "polhode/scene/scene.hpp"

namespace polhode {

/// What a driven body keeps, and the way back to it from a state that a series has carried off by rounding and by what
/// its tolerance leaves: the energy, or under gravity's gradient the energy less n L_z (Jacobi's integral), and L_z
/// where no torque acts about the vertical. A symmetric top's p_psi needs no help: its derivative is exactly zero.
///
/// One Newton step of the rate variables towards the values at the start, from residuals in double-double. Its metric
/// leaves to u and v their relative accuracy, and untouched what stays by itself. Projection on invariants: Hairer,
/// Lubich & Wanner 2006, Geometric Numerical Integration, IV.4.
class SeriesInvariants {
 public:
  /// What a carried vector of four or three numbers is.
  enum class Sees { nothing, vertical, attitude };

  SeriesInvariants() = default;   ///< keeps nothing
  /// @param I_P, moment_P  principal moments; weight times arm, all bodies' weights together
  /// @param half_over_k    w1 = (v - u) / 2k of separatrix variables
  SeriesInvariants(const Scene& scene, const SeriesTerms& terms, const Vector3d& I_P, const Vector3d& moment_P,
                   int gradients, double orbit_phase, const math::DD& half_over_k, Sees sees);

  /// The values that are to be kept are those of this state.
  void start(double t0, const double* y, const double* carry);
  bool any() const { return first_ || second_; }
  /// Moves the rates of a state at time t.
  void restore(math::DD t, double* y, double* carry) const;

 private:
  struct Values;
  Values compute(math::DD t, const double* y, const double* carry) const;

  bool first_ = false, second_ = false;   ///< energy or Jacobi's integral; L_z
  bool separatrix_ = false, alone_[3] = {};   ///< a rate that nothing changes
  Sees sees_ = Sees::nothing;
  /// In units of the body's own inertia and rate.
  double I_[3] = {}, moment_[3] = {}, tidal_ = 0.0, orbit_rate_ = 0.0, orbit_phase_ = 0.0;
  double slow_ = 1.0, orbit_ = 0.0;       ///< rates times this are near 1; orbit_rate_ among them
  double exchanged_ = 0.0;                ///< size of the potential energy
  math::DD half_over_k_, kept_[2];
};

}  // namespace polhode
