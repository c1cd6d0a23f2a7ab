#pragma once

#include <algorithm>
#include <cmath>

#include "heavy_top_cubic.hpp"
#include "polhode/core/error.hpp"

namespace polhode::exact {

/// A motion next to a stable vertical is linear in its distance from it to 1e-48 when that is below 2^-80: smaller ones
/// are enlarged to about 2^-120, so that no product underflows, and their constants reduced again.
class Enlargement {
 public:
  /// Changes the start where needed; refuses what no float64 can follow.
  Enlargement(HeavyTopStart& s, const TiltStart& t) : upright_(t.op > t.om) {
    using math::DD;
    const double stiffness = (t.a * t.a - (upright_ ? t.bt + t.bt : -(t.bt + t.bt))).hi;  // > 0 when stable
    const bool stable = stiffness > 1e-20 * (t.a.hi * t.a.hi + t.bt.hi);
    const double rate = stable ? std::sqrt(stiffness) : 1.0;
    DD &p = upright_ ? s.x : s.z, &q = upright_ ? s.y : s.w;
    const double distance =
        std::max({std::abs(p.hi), std::abs(q.hi), std::abs(s.w1.hi) / rate, std::abs(s.w2.hi) / rate});
    if (distance == 0.0 || distance >= 0x1p-160) return;
    if (!stable) {
      if (distance >= 0x1p-230) return;
      throw InvalidInput("attitude", "further from the unstable upright position, or exactly in it",
                         "a tilt or kick of " + to_text(distance) + " beside 1", "float64 cannot follow it from there");
    }
    factor_ = std::ldexp(1.0, -120 - std::ilogb(distance));
    for (DD* small : {&p, &q, &s.w1, &s.w2}) *small = math::scaled(*small, factor_);
  }

  void undo(HeavyTopConstants& c, HeavyTopMotion& motion) const {
    if (factor_ == 1.0) return;
    double* const small[] = {&c.w12_re, &c.w12_im, upright_ ? &c.cb_re : &c.ca_re, upright_ ? &c.cb_im : &c.ca_im,
                             upright_ ? &motion.sin_low : &motion.cos_low,
                             upright_ ? &motion.sin_high : &motion.cos_high};
    for (double* value : small) *value /= factor_;
  }

 private:
  bool upright_;
  double factor_ = 1.0;
};

}  // namespace polhode::exact
