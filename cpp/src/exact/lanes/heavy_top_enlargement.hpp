#pragma once

#include <cmath>

#include "exact/lanes/heavy_top_cubic.hpp"

namespace polhode::POLHODE_ISA {

/// A motion near a stable vertical is linear in its distance from it, to 1e-48 if the distance is below 2^-80.
/// Distances below 2^-160 are enlarged to about 2^-120, so that no product underflows. The constants are reduced again.
class Enlargement {
 public:
  /// Changes the start if needed. Sets motion.lost_within for a motion that float64 cannot follow.
  Enlargement(HeavyTopStart& s, const TiltStart& t, HeavyTopMotion& motion) : upright_(t.op > t.om) {
    const double stiffness = (t.a * t.a - (upright_ ? t.bt + t.bt : -(t.bt + t.bt))).hi;  // > 0 when stable
    const bool stable = stiffness > 1e-20 * (t.a.hi * t.a.hi + t.bt.hi);
    const double rate = stable ? sqrt(stiffness) : 1.0;
    DD &p = upright_ ? s.x : s.z, &q = upright_ ? s.y : s.w;
    const double distance =
        math::max(math::max(abs(p.hi), abs(q.hi)), math::max(abs(s.w1.hi), abs(s.w2.hi)) / rate);
    if (distance == 0.0 || distance >= 0x1p-160) return;
    if (!stable) {
      if (distance < 0x1p-230) motion.lost_within = distance;
      return;
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

}  // namespace polhode::POLHODE_ISA
