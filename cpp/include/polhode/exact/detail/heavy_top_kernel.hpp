#pragma once

#include "polhode/core/quat.hpp"
#include "polhode/math/detail/exp.hpp"
#include "polhode/math/detail/phase.hpp"
#include "polhode/math/detail/sincos.hpp"

// Lagrange's top at one time, from precomputed constants. The Cayley-Klein parameters are quotients of theta functions
// with two phase rates (Klein & Sommerfeld, Ueber die Theorie des Kreisels, 1897-1910, chapter 6). The derivation, with
// the names used here, is in docs/heavy_top.md. Templates over a lane type V as in polhode/math/number.hpp.
namespace polhode::exact {

// Named here, so that the C library's functions in the global namespace are never chosen and lanes find their own.
using math::abs, math::copysign, math::madd, math::rint, math::select, math::sqrt;
using math::cycle_fraction, math::exp_both, math::few_cycles, math::polynomial, math::sincos_cycles;
using math::two_diff, math::two_prod, math::two_sum;

/// a b + c d and a b - c d.
template <class V>
POLHODE_INLINE V plus(V a, V b, V c, V d) {
  return madd(a, b, c * d);
}
template <class V>
POLHODE_INLINE V less(V a, V b, V c, V d) {
  return madd(a, b, -(c * d));
}

inline constexpr int degree_12 = 8;  ///< of the polynomials of omega: their terms fall as q^(n^2 / 2), q <= 0.21

/// A rate or an angle in cycles, as a double-double.
struct Cycles {
  double hi = 0.0, lo = 0.0;
};

/// The constants of one top. Time is in units of 1 / rate_scale, the phases in cycles.
/// The pair (alpha, beta) = (w + i z, x + i y) of the attitude q_WS is a common factor times
/// (c_a e^{i a} N1, c_b e^{i b} N2).
struct HeavyTopConstants {
  bool hyper = false;        ///< which of the two forms below is filled
  double rate_scale = 1.0;   ///< a power of two [1/s]
  Cycles rate_z;             ///< of the nutation: cycles of the theta argument (trig), passages (hyper)
  Cycles rate_a, rate_b;     ///< of the phases of alpha and beta
  double start_z = 0.0;      ///< cycles (trig), passages (hyper)
  double speed = 0.0;        ///< d/dt of the theta argument [rad]
  double sum_k = 0.0;  ///< k_A + k_B [rad]
  double ca_re = 0.0, ca_im = 0.0, cb_re = 0.0, cb_im = 0.0;
  double w12_re = 0.0, w12_im = 0.0;  ///< 2 conj(c_a) c_b, times rate_scale
  double w3 = 0.0;                    ///< constant spin about the axis [rad/s]
  Quat q_SB;                          ///< from body to working axes (symmetry axis third, centre of mass up it)
  double R_BS[9] = {};                ///< the same as a row-major matrix, for omega

  bool framed = false;                ///< whether q_SB is not the identity

  // Trig: with X = cos 2z, N1 = sin z p0(X) + i cos z p1(X), N2 = cos z p2(X) + i sin z p3(X), and the rotating part of
  // omega, speed (conj(N1) N2' - N2 conj(N1')) + i sum_k conj(N1) N2 = even(X) + i sin z cos z odd(X); monomials.
  double p[4][5] = {};
  double even[degree_12 + 1] = {}, odd[degree_12 + 1] = {};

  // Hyper: N1 and N2 in powers of e^{-|v|}; eta as cosines and sines of (2n+1) eta_A and 2n eta_B.
  double v_rate_hi = 0.0, v_rate_lo = 0.0, v_start_hi = 0.0, v_start_lo = 0.0, v_passage_hi = 0.0, v_passage_lo = 0.0;
  double nome = 0.0;                ///< q' of the complementary modulus
  Cycles passage_a, passage_b;      ///< phase of alpha and beta added by each passage
  double cos_a[4] = {}, sin_a[4] = {}, cos_b[4] = {}, sin_b[4] = {};
};

/// The result of a kernel: w_B [rad/s] and q_WB, unit.
template <class V>
struct HeavyTopState {
  V w1, w2, w3, x, y, z, w;
};

/// N1, N2 and their derivatives by the theta argument, up to one common real factor.
template <class V>
struct HeavyTopSums {
  V n1_re, n1_im, n2_re, n2_im, d1_re, d1_im, d2_re, d2_im;
};

/// The same functions in the exponentials of the complementary modulus: E = e^{-|v|}, g = q' / E^2 <= 1, everything
/// times E. `sign` is that of v. N is double-double in the set-up.
template <class N>
POLHODE_INLINE HeavyTopSums<N> heavy_top_hyper_sums(const N (&cos_a)[4], const N (&sin_a)[4], const N (&cos_b)[4],
                                                    const N (&sin_b)[4], N nome, N sign, N E, N g) {
  // u, d: growing and decaying exponentials of N1 (and theta); a, b: of N2.
  N u = N(1.0), d = E * E, a = E, b = E, q_n = N(1.0);
  HeavyTopSums<N> s{N(0.0), N(0.0), E, N(0.0), N(0.0), N(0.0), N(0.0), N(0.0)};
  const N E2 = E * E;
  for (int n = 0; n < 4; ++n) {
    const N alternate = N(n % 2 == 0 ? 1.0 : -1.0);
    if (n > 0) {
      a = a * g * q_n;        // E g^n q'^(n^2 - n), with q_n = q'^(2n-2)
      b = b * (q_n * nome) * E2;
      u = u * g * (q_n * nome);
      q_n = q_n * nome * nome;
      d = d * q_n * E2;
      const N even = N(2.0 * n), sum = alternate * (a + b), difference = alternate * sign * (a - b);
      s.n2_re = s.n2_re + sum * cos_b[n];
      s.n2_im = s.n2_im - difference * sin_b[n];
      s.d2_re = s.d2_re + even * (difference * cos_b[n]);
      s.d2_im = s.d2_im - even * (sum * sin_b[n]);
    }
    const N odd = N(2.0 * n + 1.0), sum = alternate * (u + d), difference = alternate * sign * (u - d);
    s.n1_re = s.n1_re + difference * cos_a[n];
    s.n1_im = s.n1_im - sum * sin_a[n];
    s.d1_re = s.d1_re + odd * (sum * cos_a[n]);
    s.d1_im = s.d1_im - odd * (difference * sin_a[n]);
  }
  return s;
}

/// The hyperbolic form, for k^2 > 0.97 up to the homoclinic motion. `passages` receives the number of nutations.
template <class V>
POLHODE_INLINE HeavyTopSums<V> heavy_top_hyper(const HeavyTopConstants& c, V s, V& passages) {
  passages = rint(madd(s, V(c.rate_z.hi), V(c.start_z)));
  const auto travelled = two_prod(s, V(c.v_rate_hi)), done = two_prod(passages, V(c.v_passage_hi));
  const auto left = two_diff(travelled.hi, done.hi), sum = two_sum(left.hi, V(c.v_start_hi));
  const V rest = madd(s, V(c.v_rate_lo), travelled.lo) - madd(passages, V(c.v_passage_lo), done.lo);
  const V v = sum.hi + (sum.lo + (left.lo + (rest + V(c.v_start_lo))));
  V E, inverse;
  exp_both(abs(v), E, inverse);
  const V nome = V(c.nome);
  // If q' is nearly 0, e^{-|v|} may be far smaller still, and the growing terms are absent.
  const V g = select(nome > V(1e-290), nome * inverse * inverse, V(0.0));
  V ca[4], sa[4], cb[4], sb[4];
  for (int n = 0; n < 4; ++n) {
    ca[n] = V(c.cos_a[n]), sa[n] = V(c.sin_a[n]);
    cb[n] = V(c.cos_b[n]), sb[n] = V(c.sin_b[n]);
  }
  return heavy_top_hyper_sums<V>(ca, sa, cb, sb, nome, copysign(V(1.0), v), E, g);
}

/// alpha and beta before the rotation by their phases, and 1 / (|alpha|^2 + |beta|^2) with its root.
template <class V>
struct HeavyTopPair {
  V a_re, a_im, b_re, b_im, inverse2, inverse;
};

template <class V>
POLHODE_INLINE HeavyTopPair<V> heavy_top_pair(const HeavyTopConstants& c, V n1_re, V n1_im, V n2_re, V n2_im) {
  const V ca_re = V(c.ca_re), ca_im = V(c.ca_im), cb_re = V(c.cb_re), cb_im = V(c.cb_im);
  const V a_re = less(ca_re, n1_re, ca_im, n1_im), a_im = plus(ca_re, n1_im, ca_im, n1_re);
  const V b_re = less(cb_re, n2_re, cb_im, n2_im), b_im = plus(cb_re, n2_im, cb_im, n2_re);
  const V inverse = math::inverse_sqrt(plus(a_re, a_re, a_im, a_im) + plus(b_re, b_re, b_im, b_im));
  return {a_re, a_im, b_re, b_im, inverse * inverse, inverse};
}

/// The trigonometric series, for k^2 <= 0.97, from the sine and cosine of z.
template <class V>
POLHODE_INLINE HeavyTopPair<V> heavy_top_trig(const HeavyTopConstants& c, V sz, V cz) {
  const V X = (cz + sz) * (cz - sz);
  return heavy_top_pair(c, sz * polynomial(c.p[0], X), cz * polynomial(c.p[1], X), cz * polynomial(c.p[2], X),
                        sz * polynomial(c.p[3], X));
}

/// The rotating part of omega.
template <class V>
struct HeavyTopTransverse {
  V re, im;
};

template <class V>
POLHODE_INLINE HeavyTopTransverse<V> heavy_top_trig_transverse(const HeavyTopConstants& c, V sz, V cz) {
  const V X = (cz + sz) * (cz - sz);
  return {polynomial(c.even, X), (sz * cz) * polynomial(c.odd, X)};
}

/// The same from the hyperbolic sums.
template <class V>
POLHODE_INLINE HeavyTopTransverse<V> heavy_top_transverse(const HeavyTopConstants& c, const HeavyTopSums<V>& f) {
  const V t_re = plus(f.n1_re, f.d2_re, f.n1_im, f.d2_im) - plus(f.n2_re, f.d1_re, f.n2_im, f.d1_im);
  const V t_im = less(f.n1_re, f.d2_im, f.n1_im, f.d2_re) + less(f.n2_re, f.d1_im, f.n2_im, f.d1_re);
  const V q_re = plus(f.n1_re, f.n2_re, f.n1_im, f.n2_im), q_im = less(f.n1_re, f.n2_im, f.n1_im, f.n2_re);
  const V speed = V(c.speed), sum_k = V(c.sum_k);
  return {less(speed, t_re, sum_k, q_im), plus(speed, t_im, sum_k, q_re)};
}

/// The state from the pair, the rotating part of omega, and e^{i a}, e^{i b} of the phases of alpha and beta. `framed`
/// may be false only if c.framed is. It is a template argument, so that lanes share one form.
template <bool framed, class V>
POLHODE_INLINE HeavyTopState<V> heavy_top_state(const HeavyTopConstants& c, const HeavyTopPair<V>& f,
                                                const HeavyTopTransverse<V>& transverse, V ea_re, V ea_im, V eb_re,
                                                V eb_im) {
  const V qw = f.inverse * less(f.a_re, ea_re, f.a_im, ea_im), qz = f.inverse * plus(f.a_re, ea_im, f.a_im, ea_re);
  const V qx = f.inverse * less(f.b_re, eb_re, f.b_im, eb_im), qy = f.inverse * plus(f.b_re, eb_im, f.b_im, eb_re);

  // w1 + i w2 = 2 (conj(alpha) beta' - beta conj(alpha')): the derivative of the common factor drops out
  const V s_re = f.inverse2 * transverse.re, s_im = f.inverse2 * transverse.im;
  const V r_re = plus(ea_re, eb_re, ea_im, eb_im), r_im = less(ea_re, eb_im, ea_im, eb_re);
  const V h_re = less(V(c.w12_re), r_re, V(c.w12_im), r_im), h_im = plus(V(c.w12_re), r_im, V(c.w12_im), r_re);
  const V w1 = less(h_re, s_re, h_im, s_im), w2 = plus(h_re, s_im, h_im, s_re), w3 = V(c.w3);
  if constexpr (!framed) return {w1, w2, w3, qx, qy, qz, qw};

  const double* R = c.R_BS;
  const Quat& b = c.q_SB;
  return {madd(V(R[2]), w3, plus(V(R[0]), w1, V(R[1]), w2)),
          madd(V(R[5]), w3, plus(V(R[3]), w1, V(R[4]), w2)),
          madd(V(R[8]), w3, plus(V(R[6]), w1, V(R[7]), w2)),
          plus(qw, V(b.x), qx, V(b.w)) + less(qy, V(b.z), qz, V(b.y)),
          plus(qw, V(b.y), qy, V(b.w)) + less(qz, V(b.x), qx, V(b.z)),
          plus(qw, V(b.z), qz, V(b.w)) + less(qx, V(b.y), qy, V(b.x)),
          less(qw, V(b.w), qx, V(b.x)) - plus(qy, V(b.y), qz, V(b.z))};
}

/// The state at time t. `hyper` must be c.hyper.
template <bool hyper, bool framed, class V>
POLHODE_INLINE HeavyTopState<V> evaluate_heavy_top(const HeavyTopConstants& c, V t) {
  const V s = t * V(c.rate_scale);
  V phase_a = V(0.0), phase_b = V(0.0);
  HeavyTopPair<V> f;
  HeavyTopTransverse<V> transverse;
  if constexpr (hyper) {
    V passages;
    const HeavyTopSums<V> sums = heavy_top_hyper(c, s, passages);
    f = heavy_top_pair(c, sums.n1_re, sums.n1_im, sums.n2_re, sums.n2_im);
    transverse = heavy_top_transverse(c, sums);
    phase_a = cycle_fraction(passages, V(c.passage_a.hi), V(c.passage_a.lo), V(0.0));
    phase_b = cycle_fraction(passages, V(c.passage_b.hi), V(c.passage_b.lo), V(0.0));
  } else {
    V sz, cz;
    sincos_cycles(few_cycles(s, V(c.rate_z.hi), V(c.rate_z.lo), V(c.start_z)), sz, cz);
    f = heavy_top_trig(c, sz, cz);
    transverse = heavy_top_trig_transverse(c, sz, cz);
  }
  V ea_re, ea_im, eb_re, eb_im;
  sincos_cycles(few_cycles(s, V(c.rate_a.hi), V(c.rate_a.lo), phase_a), ea_im, ea_re);
  sincos_cycles(few_cycles(s, V(c.rate_b.hi), V(c.rate_b.lo), phase_b), eb_im, eb_re);
  return heavy_top_state<framed>(c, f, transverse, ea_re, ea_im, eb_re, eb_im);
}

}  // namespace polhode::exact
