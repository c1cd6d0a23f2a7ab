#pragma once

#include <cmath>

#include "exact/lanes/heavy_top_cubic.hpp"
#include "polhode/math/detail/functions.hpp"
#include "polhode/math/detail/landen.hpp"

namespace polhode::POLHODE_ISA {

/// The root of c3 x^3 + c2 x^2 + c1 x + c0 next to `start`, which lies outside all roots, so that Newton's steps are
/// monotone. In double until they reverse, then three steps in double-double.
inline DD far_root(DD c3, DD c2, DD c1, DD c0, double start) {
  double x = start;
  for (int i = 0; i < 200; ++i) {
    const double f = ((c3.hi * x + c2.hi) * x + c1.hi) * x + c0.hi;
    const double slope = (3.0 * c3.hi * x + 2.0 * c2.hi) * x + c1.hi;
    const double next = x - f / slope;
    if (!(abs(next) < abs(x)) || abs(x - next) < 1e-15 * abs(x)) break;
    x = next;
  }
  DD root = x;
  for (int i = 0; i < 3; ++i) {
    const DD f = ((c3 * root + c2) * root + c1) * root + c0;
    const DD slope = (DD(3.0) * c3 * root + c2 + c2) * root + c1;
    if (slope.hi == 0.0) break;
    root = root - f / slope;
  }
  return root;
}

inline TiltStart::TiltStart(const HeavyTopStart& s) {
  a = s.C * s.w3 / s.A;
  bt = (s.M + s.M) / s.A;
  wp2 = squared(s.w1) + squared(s.w2);
  const DD sine = squared(s.x) + squared(s.y), cosine = squared(s.z) + squared(s.w);
  om = sine + sine, op = cosine + cosine, u0 = cosine - sine;
  const DD half1 = s.x * s.z - s.w * s.y, half2 = s.y * s.z + s.w * s.x;
  const DD g1 = half1 + half1, g2 = half2 + half2;
  sv = s.w1 * g1 + s.w2 * g2;
  du0 = g1 * s.w2 - g2 * s.w1;
  ab = sv + a * op;
  ba = sv - a * om;
  const DD two_u0 = u0 + u0;
  c2 = bt * two_u0 - wp2 - a * a;
  c1 = a * (sv + sv) - bt * om * op - two_u0 * wp2;
  c0 = du0 * du0;
}

inline TiltCubic::TiltCubic(const TiltStart& t) : ab(t.ab), ba(t.ba) {
  const DD &bt = t.bt, &c2 = t.c2, &c1 = t.c1, &c0 = t.c0;
  const DD b1 = bt * c1, b0 = bt * bt * c0;
  const DD bend = DD(2.0) * c2 * c2 * c2 / DD(27.0) - c2 * b1 / DD(3.0) + b0;
  DD Sg, f;
  const bool upper = bend.hi < 0.0;  // the far root is d3, else d1
  if (upper) {
    const double start = 2.0 * math::max(abs(c2.hi), math::max(sqrt(abs(b1.hi)), math::cbrt(b0.hi / 2.0)));
    e3 = far_root(DD(1.0), c2, b1, b0, start);
    const DD G = t.du0 / sqrt(e3), F = -(bt * squared(G) + c1) / e3;  // d1 d2 = -G^2, d1 + d2 = -F
    D = math::hypotenuse(abs(F), abs(G + G));
    if (F.hi <= 0.0) {
      d2 = math::scaled(D - F, 0.5);
      d1 = -G * (G / d2);
    } else {
      d1 = -math::scaled(D + F, 0.5);
      d2 = -G * (G / d1);
    }
    Sg = e3 + bt * (d2 - t.om - t.om);
  } else {
    DD g;
    if (c0.hi == 0.0 && c1.hi > 0.0) {
      d1 = DD(0.0);
    } else {
      const double b = bt.hi;
      const double start =
          -math::min(t.op.hi * 1.0000001,
                     2.0 * math::max(abs(c2.hi / b), math::max(sqrt(abs(c1.hi / b)), math::cbrt(c0.hi / b / 2.0))));
      d1 = far_root(bt, c2, c1, c0, start);
    }
    const double size = bt.hi * -(d1.hi * d1.hi * d1.hi);
    if (d1.hi != 0.0 && size >= c0.hi) {
      g = -c0 / d1;
      f = (g - c1) / d1;
    } else {
      f = c2 + bt * d1;
      g = c1 + f * d1;
    }
    Sg = -f - DD(2.0) * bt * t.om;
    d2 = g;  // divided below
  }
  e1 = t.om - d1;
  const DD P = ba * sqrt(bt / e1), Pi = squared(P), R = math::hypotenuse(abs(Sg), abs(P + P));
  if (!upper) {
    e3 = math::scaled(R - f, 0.5);
    d2 = (d2 + d2) / (R - f);
    D = d2 - d1;
  }
  const auto ratio = [](DD above, DD below) { return above.hi == 0.0 ? DD(0.0) : above / below; };
  X3 = Sg.hi >= 0.0 ? math::scaled(Sg + R, 0.5) : ratio(Pi + Pi, R - Sg);
  x2 = Sg.hi >= 0.0 ? ratio(squared(ba), e1 * X3) : (R - Sg) / (bt + bt);
  mu2 = t.op + d2;
  m3 = bt * t.op + e3;
  mu1 = ratio(squared(ab), mu2 * m3);
  E = e3 - bt * d1;
  kc2_E = upper ? e3 - bt * d2 : R;
}

}  // namespace polhode::POLHODE_ISA
