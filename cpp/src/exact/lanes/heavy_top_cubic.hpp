#pragma once

#include "exact/heavy_top_start.hpp"
#include "exact/lanes/heavy_top_complex.hpp"

namespace polhode::POLHODE_ISA {

using exact::HeavyTopConstants, exact::HeavyTopMotion, exact::HeavyTopStart;

/// The start in terms of u = cos(tilt), and the cubic f(d) = u'^2 = bt d^3 + c2 d^2 + c1 d + c0 in d = u - u0.
/// It is shifted to the start, so that small motions keep their digits.
struct TiltStart {
  math::DD a, bt;         ///< C w3 / A and 2 M / A
  math::DD wp2;           ///< w1^2 + w2^2
  math::DD om, op, u0;    ///< 1 - u0, 1 + u0, u0
  math::DD sv, du0;       ///< b - a u0 with b = p_phi / A, and u' at the start
  math::DD ab, ba;        ///< a + b and b - a
  math::DD c2, c1, c0;

  explicit TiltStart(const HeavyTopStart& s);
};

/// The three roots d1 <= 0 <= d2 <= d3, and quantities derived from them without cancellation.
struct TiltCubic {
  math::DD d1, d2, D;     ///< D = d2 - d1
  math::DD e3;            ///< bt d3, finite when the weight goes to zero
  math::DD E;             ///< bt (d3 - d1)
  math::DD kc2_E;         ///< bt (d3 - d2) = k'^2 E
  math::DD e1, mu1;       ///< 1 - u1, 1 + u1
  math::DD x2, mu2;       ///< 1 - u2, 1 + u2
  math::DD X3, m3;        ///< bt (u3 - 1), bt (1 + u3)
  math::DD ab, ba;

  explicit TiltCubic(const TiltStart& t);
};

}  // namespace polhode::POLHODE_ISA
