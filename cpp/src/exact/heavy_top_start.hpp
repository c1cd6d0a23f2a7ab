#pragma once

#include "polhode/exact/heavy_top.hpp"
#include "polhode/exact/detail/heavy_top_kernel.hpp"
#include "polhode/math/detail/double_double.hpp"

namespace polhode::exact {

/// The start in the working axes S: moments (A, A, C), weight_arm M >= 0 along +z. All is scaled by powers of two, so
/// that the largest of A, |omega|, sqrt(M / A) is near 1.
struct HeavyTopStart {
  math::DD A, C, M;
  math::DD w1, w2, w3;
  math::DD x, y, z, w;  ///< q_WS, not yet normalised
};

/// Properties of the motion besides its constants, in the scaled units and working axes.
struct HeavyTopMotion {
  TopKind kind = TopKind::steady_precession;
  double sin_low = 0, cos_low = 0;    ///< of half the tilt at the lowest point, times sqrt(2)
  double sin_high = 0, cos_high = 0;  ///< the same at the highest point
  double period = 0;                             ///< of the tilt; inf when it never returns or never leaves
  double precession = 0;                         ///< mean d(phi)/dt
  math::DD energy, p_phi, p_psi;
  double lost_within = 0;  ///< not 0: too near the unstable vertical for float64; nothing else is filled
};

}  // namespace polhode::exact
