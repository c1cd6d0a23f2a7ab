#pragma once

#include "polhode/exact/detail/free_series.hpp"

// The free gyrostat at one time, from the constants of its theta series. The derivation, with the names used here, is
// in docs/gyrostat.md. Templates over a lane type T as in polhode/math/detail/number.hpp.
namespace polhode::exact {

inline constexpr int gyrostat_trig_terms = 7;    ///< |j| of the spinor: the next term is below 1e-19
inline constexpr int gyrostat_trig_rates = 10;   ///< |n| of the rates
inline constexpr int gyrostat_hyper_terms = 8;
inline constexpr int gyrostat_hyper_rates = 12;

/// One real function of phi: cos and sin of 2m phi and (2m + 1) phi as monomials in X = cos 2 phi.
template <int even, int odd>
struct PhasePolynomials {
  double even_cos[even], even_sin[even - 1], odd_cos[odd], odd_sin[odd];
};
using GyrostatSpinorPart = PhasePolynomials<4, 4>;
using GyrostatRatePart = PhasePolynomials<6, 5>;

/// The pair alpha = w + iz, beta = x + iy of the attitude in the frame of the momentum, as a common phase and a common
/// factor times one theta series; J_i omega_i times the squared length of the pair is a series of the same kind.
/// Trig: powers of e^{i phi}, phi = nu t. Hyper: powers of e^v, with v in one half passage to each side of 0.
struct GyrostatSeries {
  bool hyper = false;
  double kappa_hi = 0.0, kappa_lo = 0.0;  ///< the common phase, cycles per unit of time
  double nu_hi = 0.0, nu_lo = 0.0;        ///< phi in cycles, or v in passages, per unit of time
  GyrostatSpinorPart spinor[4] = {};      ///< Re alpha, Im alpha, Re beta, Im beta
  GyrostatRatePart rate[3] = {};          ///< omega in working axes

  double start = 0.0;                           ///< of v, in passages
  double v_start_hi = 0.0, v_start_lo = 0.0;    ///< of v
  double v_rate_hi = 0.0, v_rate_lo = 0.0;      ///< dv/dt
  double v_passage_hi = 0.0, v_passage_lo = 0.0;  ///< -ln |Q|
  double kappa_passage_hi = 0.0, kappa_passage_lo = 0.0;  ///< cycles of the common phase that a passage adds
  double alternates = 0.0;                      ///< 1: odd powers change their sign with each passage (Q < 0)
  double nome = 0.0;                            ///< |Q|; 0 where the growing terms are nothing
  /// The coefficients of v^j, without the powers of |Q| that e^v brings: j = 0, 1 ..., then -1, -2, ...
  double hyper_spinor[4][2 * gyrostat_hyper_terms + 1] = {};
  double hyper_rate[3][2 * gyrostat_hyper_rates + 1] = {};
};

template <int even, int odd, class T>
POLHODE_INLINE T evaluate(const PhasePolynomials<even, odd>& p, T X, T sin2, T s, T c) {
  return madd(c, polynomial(p.odd_cos, X), polynomial(p.even_cos, X)) +
         madd(s, polynomial(p.odd_sin, X), sin2 * polynomial(p.even_sin, X));
}

/// The pair before the common phase, with its scale.
template <class T>
POLHODE_INLINE FreePair<T> gyrostat_trig_pair(const GyrostatSeries& body, T s, T c) {
  const T X = (c - s) * (c + s), sin2 = (s + s) * c;
  T part[4];
  for (int i = 0; i < 4; ++i) part[i] = evaluate(body.spinor[i], X, sin2, s, c);
  const T size2 = madd(part[0], part[0], part[1] * part[1]) + madd(part[2], part[2], part[3] * part[3]);
  return {part[0], part[1], part[2], part[3], inverse_sqrt(size2)};
}

/// The state from the pair and the sines and cosines of phi (s, c) and of the common phase (ks, kc).
template <class T>
POLHODE_INLINE FreeState<T> gyrostat_trig_state(const GyrostatSeries& body, const FreePair<T>& p, T s, T c, T ks,
                                                T kc) {
  FreeState<T> out;
  rotate_and_normalise(p.re_a, p.im_a, p.re_b, p.im_b, p.scale, ks, kc, out);
  const T X = (c - s) * (c + s), sin2 = (s + s) * c, inverse = p.scale * p.scale;
  for (int i = 0; i < 3; ++i) out.omega[i] = evaluate(body.rate[i], X, sin2, s, c) * inverse;
  return out;
}

/// Powers e^{jv} of one passage, times e^-|v|: those with j > 0 are first * step^(j - 1), without |Q|^(j - 1).
template <class T>
struct GyrostatPowers {
  T E, flip, up_first, up_step, down_first, down_step;
};

template <class T>
POLHODE_INLINE GyrostatPowers<T> gyrostat_powers(const GyrostatSeries& body, T v, T v_low, T passages) {
  GyrostatPowers<T> p;
  const T sign = copysign(T(1.0), v), Q = T(body.nome);
  const T E = math::exp_minus(abs(v)), half = T(0.5) * passages;
  p.E = madd(-(sign * v_low), E, E);
  p.flip = T(1.0) - T(4.0 * body.alternates) * abs(half - rint(half));
  const T grown = Q / p.E, fallen = p.E * Q, E2 = p.E * p.E;
  const auto up = v > T(0.0);
  p.up_first = p.flip * select(up, T(1.0), E2), p.down_first = p.flip * select(up, E2, T(1.0));
  p.up_step = p.flip * select(up, grown, fallen), p.down_step = p.flip * select(up, fallen, grown);
  return p;
}

/// c[0] middle + up_first (c[1] + c[2] up_step + ...) + down_first (c[terms + 1] + ...).
template <int terms, class T>
POLHODE_INLINE T gyrostat_sum(const double (&c)[2 * terms + 1], T up_step, T down_step, T& up, T& down) {
  up = T(c[terms]), down = T(c[2 * terms]);
  for (int j = terms - 1; j >= 1; --j) {
    up = madd(up, up_step, T(c[j]));
    down = madd(down, down_step, T(c[terms + j]));
  }
  return T(c[0]);
}

template <class T>
POLHODE_INLINE FreeState<T> gyrostat_hyper_state(const GyrostatSeries& body, const GyrostatPowers<T>& p, T ks, T kc) {
  T part[4];
  for (int i = 0; i < 4; ++i) {
    T up, down;
    const T middle = gyrostat_sum<gyrostat_hyper_terms>(body.hyper_spinor[i], p.up_step, p.down_step, up, down);
    part[i] = madd(up, p.up_first, madd(down, p.down_first, middle * p.E));
  }
  const T size2 = madd(part[0], part[0], part[1] * part[1]) + madd(part[2], part[2], part[3] * part[3]);
  const T scale = inverse_sqrt(size2), inverse = scale * scale;
  FreeState<T> out;
  rotate_and_normalise(part[0], part[1], part[2], part[3], scale, ks, kc, out);
  // The rates: powers n = 0, +-1 by themselves, then those from +-2 on, which are squares of the first powers.
  const T up1 = p.up_first * p.E, down1 = p.down_first * p.E, E2 = p.E * p.E;
  const T up2 = p.up_first * p.up_first, down2 = p.down_first * p.down_first;
  for (int i = 0; i < 3; ++i) {
    constexpr int n = gyrostat_hyper_rates;
    const double(&c)[2 * n + 1] = body.hyper_rate[i];
    T up = T(c[n]), down = T(c[2 * n]);
    for (int j = n - 1; j >= 2; --j) {
      up = madd(up, p.up_step, T(c[j]));
      down = madd(down, p.down_step, T(c[n + j]));
    }
    const T near = madd(T(c[1]), up1, madd(T(c[n + 1]), down1, T(c[0]) * E2));
    out.omega[i] = madd(up, up2, madd(down, down2, near)) * inverse;
  }
  return out;
}

/// The angles of one time: the sine and cosine of the common phase, and v with its low part and whole passages.
template <class T>
struct GyrostatPassage {
  T v, v_low, passages, sine, cosine;
};

template <class T>
POLHODE_INLINE GyrostatPassage<T> gyrostat_passage(const GyrostatSeries& body, T t) {
  const T passages = rint(madd(t, T(body.nu_hi), T(body.start)));
  const auto travelled = two_prod(t, T(body.v_rate_hi)), done = two_prod(passages, T(body.v_passage_hi));
  const auto left = two_sum(travelled.hi, -done.hi), sum = two_sum(left.hi, T(body.v_start_hi));
  const T rest = madd(t, T(body.v_rate_lo), travelled.lo) - madd(passages, T(body.v_passage_lo), done.lo);
  const T tail = sum.lo + (left.lo + (rest + T(body.v_start_lo)));
  const auto v = two_sum(sum.hi, tail);
  const T passed = cycle_fraction(passages, T(body.kappa_passage_hi), T(body.kappa_passage_lo), T(0.0));
  GyrostatPassage<T> out{v.hi, v.lo, passages, T(0.0), T(0.0)};
  sincos_cycles(few_cycles(t, T(body.kappa_hi), T(body.kappa_lo), passed), out.sine, out.cosine);
  return out;
}

template <class T>
POLHODE_INLINE FreeState<T> evaluate_gyrostat(const GyrostatSeries& body, T t) {
  if (body.hyper) {
    const GyrostatPassage<T> now = gyrostat_passage(body, t);
    return gyrostat_hyper_state(body, gyrostat_powers(body, now.v, now.v_low, now.passages), now.sine, now.cosine);
  }
  T s, c, ks, kc;
  sincos_cycles(few_cycles(t, T(body.nu_hi), T(body.nu_lo), T(0.0)), s, c);
  sincos_cycles(few_cycles(t, T(body.kappa_hi), T(body.kappa_lo), T(0.0)), ks, kc);
  return gyrostat_trig_state(body, gyrostat_trig_pair(body, s, c), s, c, ks, kc);
}

}  // namespace polhode::exact
