#pragma once

#include "polhode/math/detail/exp.hpp"
#include "polhode/math/detail/phase.hpp"
#include "polhode/math/detail/sincos.hpp"

// Torque-free motion as theta series: the constants of one body and their evaluation at a time.
// Working axes: a proper signed permutation of the principal axes with m3 >= 0 about the axis the motion encircles;
// working space frame: third axis along the angular momentum. docs/exact.md derives everything here.
namespace polhode::exact {

// Named here, so that the C library's functions in the global namespace are never chosen.
using math::DoubleDouble;
using math::abs, math::copysign, math::madd, math::max, math::min, math::rint, math::select, math::sqrt;
using math::cycle_fraction, math::few_cycles, math::sincos_cycles, math::two_prod, math::two_sum;
using math::exp_both, math::inverse_sqrt, math::polynomial;

/// A state: the unit quaternion from working axes to the working space frame, and omega in working axes.
template <class T>
struct FreeState {
  T x, y, z, w;
  T omega[3];
};

/// k^2 <= 0.97: alpha = w + iz = e^{i kappa t} sum_{j even} G_j e^{ij phi}, beta = x + iy with j odd, up to a common
/// factor, phi = phi0 + nu t; both sums as polynomials in X = cos 2 phi. Rates in cycles per unit of time.
/// Cayley-Klein form of Jacobi's solution (Jacobi 1850; Klein & Sommerfeld 1897-1910), nome q^2.
template <class T>
struct FreeTrig {
  T nu_hi, nu_lo, phi0, kappa_hi, kappa_lo;
  T even_cos[4], even_sin[3], odd_cos[4], odd_sin[4];
  T omega[3][5];  ///< theta_1, theta_2, theta_4 with the factors of omega, over sin, cos, 1
};

/// k^2 > 0.97: the same sums after Poisson's transformation, in e^-|v|, with v in one half period.
template <class T>
struct FreeHyper {
  T rate_hi, rate_lo, start_hi, start_lo;  ///< the theta argument in half cycles (nu / pi); 0 on the separatrix
  T v_hi, v_lo;                            ///< v = v_hi * (fraction of a half cycle); on the separatrix dv/dt
  T v0_hi, v0_lo;                          ///< v at t = 0 on the separatrix, else 0
  T kappa_hi, kappa_lo, eta;               ///< cycles per unit of time; cycles
  T parity0;                               ///< half cycles to add (0 or 1)
  T q;                                     ///< the complementary nome
  T C[4], S[4];                            ///< cos, sin((2n + 1) eta / 2)
  T omega[3];                              ///< the factors of omega
  T homoclinic;                            ///< 1 exactly on the separatrix, else 0
};

/// Makes a unit quaternion of alpha and beta: rotates both by e^{i kappa t} and multiplies by the scale, which is
/// 1 / sqrt(|alpha|^2 + |beta|^2).
template <class T>
POLHODE_INLINE void rotate_and_normalise(T re_a, T im_a, T re_b, T im_b, T scale, T sine, T cosine, FreeState<T>& out) {
  const T c = cosine * scale, s = sine * scale;
  out.w = madd(re_a, c, -(im_a * s));
  out.z = madd(re_a, s, im_a * c);
  out.x = madd(re_b, c, -(im_b * s));
  out.y = madd(re_b, s, im_b * c);
}

/// alpha and beta before the rotation by kappa t, and their scale.
template <class T>
struct FreePair {
  T re_a, im_a, re_b, im_b, scale;
};

/// The pair from the sine and cosine of phi.
template <class T, class C>
POLHODE_INLINE FreePair<T> evaluate_pair(const FreeTrig<C>& body, T s, T c) {
  const T X = (c - s) * (c + s), sin2 = (s + s) * c;
  const T re_a = polynomial(body.even_cos, X), im_a = sin2 * polynomial(body.even_sin, X);
  const T re_b = c * polynomial(body.odd_cos, X), im_b = s * polynomial(body.odd_sin, X);
  const T size2 = madd(re_a, re_a, im_a * im_a) + madd(re_b, re_b, im_b * im_b);
  return {re_a, im_a, re_b, im_b, inverse_sqrt(size2)};
}

/// The working axes in their own order.
inline constexpr int in_order[3] = {0, 1, 2};

/// The state from the pair and the sines and cosines of phi (s, c) and of kappa t (ks, kc). Row i of body.omega belongs
/// to the working axis order[i]: omega may come in another order of the axes. A zero of omega is +0.
template <class T, class C>
POLHODE_INLINE FreeState<T> evaluate(const FreeTrig<C>& body, const FreePair<T>& pair, T s, T c, T ks, T kc,
                                     const int (&order)[3] = in_order) {
  FreeState<T> out;
  rotate_and_normalise(pair.re_a, pair.im_a, pair.re_b, pair.im_b, pair.scale, ks, kc, out);
  const T X = (c - s) * (c + s), inverse = pair.scale * pair.scale;
  const T factor[3] = {s, c, T(1.0)};
  for (int i = 0; i < 3; ++i) out.omega[i] = madd(factor[order[i]] * polynomial(body.omega[i], X), inverse, T(0.0));
  return out;
}

template <class T, class C>
POLHODE_INLINE FreeState<T> evaluate(const FreeTrig<C>& body, T t) {
  T s, c, ks, kc;
  sincos_cycles(few_cycles(t, T(body.nu_hi), T(body.nu_lo), T(body.phi0)), s, c);
  sincos_cycles(few_cycles(t, T(body.kappa_hi), T(body.kappa_lo), T(0.0)), ks, kc);
  return evaluate(body, evaluate_pair(body, s, c), s, c, ks, kc);
}

/// The cycles, to a fraction, of the low part of a time t + t_low.
template <class T>
POLHODE_INLINE T low_cycles(T t_low, T rate) {
  return cycle_fraction(t_low, rate, T(0.0), T(0.0));
}

/// The same at the time t + t_low.
template <class T, class C>
POLHODE_INLINE FreeState<T> evaluate(const FreeTrig<C>& body, T t, T t_low) {
  T s, c, ks, kc;
  const T nu(body.nu_hi), kappa(body.kappa_hi);
  sincos_cycles(few_cycles(t, nu, T(body.nu_lo), T(body.phi0) + low_cycles(t_low, nu)), s, c);
  sincos_cycles(few_cycles(t, kappa, T(body.kappa_lo), low_cycles(t_low, kappa)), ks, kc);
  return evaluate(body, evaluate_pair(body, s, c), s, c, ks, kc);
}

/// The phase between two flips: v, (-1)^N, e^-|v|, the rotation of alpha and beta, and q e^|v|.
template <class T>
struct FreePassage {
  T v, flip, E, sine, cosine, grown;
};

/// At the time t, or t + t_low if `low` holds the number t_low.
template <class T, class C, class... Low>
POLHODE_INLINE FreePassage<T> evaluate_passage(const FreeHyper<C>& body, T t, Low... low) {
  // The theta argument in half cycles, as a pair: near v = 0 its error is multiplied by pi^2 / lambda.
  const auto p = two_prod(t, T(body.rate_hi));
  const T n = rint(p.hi);
  auto half_cycles = DoubleDouble<T>(two_sum(p.hi - n, madd(t, T(body.rate_lo), p.lo))) +
                     DoubleDouble<T>(T(body.start_hi), T(body.start_lo));
  if constexpr (sizeof...(low) == 1) {
    half_cycles = half_cycles + (DoubleDouble<T>(two_prod(low, T(body.rate_hi))) + ...);
  }
  const T n2 = rint(half_cycles.hi), f = half_cycles.hi - n2;
  const T half = T(0.5) * ((n + n2) + T(body.parity0));
  const T flip = T(1.0) - T(4.0) * abs(half - rint(half));  // (-1)^N
  // On the separatrix f = 0 and v grows with t itself.
  const T argument = select(T(body.homoclinic) > T(0.5), t, f);
  const auto vp = two_prod(argument, T(body.v_hi));
  T tail = madd(argument, T(body.v_lo), madd(half_cycles.lo, T(body.v_hi), vp.lo)) + T(body.v0_lo);
  if constexpr (sizeof...(low) == 1) {
    tail = tail + select(T(body.homoclinic) > T(0.5), (low + ...) * T(body.v_hi), T(0.0));
  }
  const auto vs = two_sum(vp.hi, T(body.v0_hi));
  const T v = vs.hi + (vs.lo + tail);

  FreePassage<T> out;
  T start(0.0);
  if constexpr (sizeof...(low) == 1) start = (low_cycles(low, T(body.kappa_hi)) + ...);
  const T cycles = madd(T(body.eta), f, few_cycles(t, T(body.kappa_hi), T(body.kappa_lo), start));
  sincos_cycles(cycles, out.sine, out.cosine);
  T inverse;
  exp_both(abs(v), out.E, inverse);
  out.v = v, out.flip = flip, out.grown = select(T(body.q) < T(1e-290), T(0.0), T(body.q) * inverse);
  return out;
}

template <class T, class C>
POLHODE_INLINE FreeState<T> evaluate(const FreeHyper<C>& body, const FreePassage<T>& passage) {
  const T sign = copysign(T(1.0), passage.v), E = passage.E, flip = passage.flip;
  const T g = passage.grown, q = T(body.q);
  T u[4], d[4];
  u[0] = T(1.0);
  d[0] = E;
  T qn = T(1.0);
  for (int i = 0; i < 3; ++i) {
    u[i + 1] = u[i] * g * qn;
    qn = qn * q;
    d[i + 1] = d[i] * E * qn;
  }
  T re_a = T(0.0), im_a = T(0.0), re_b = T(0.0), im_b = T(0.0);
  for (int i = 3; i >= 0; --i) {
    const T sum = u[i] + d[i], difference = sign * (u[i] - d[i]);
    const T b = (i % 2 ? -flip : flip);
    re_a = madd(sum, T(body.C[i]), re_a);
    im_a = im_a - difference * T(body.S[i]);
    re_b = madd(b * difference, T(body.C[i]), re_b);
    im_b = im_b - b * sum * T(body.S[i]);
  }
  const T size2 = madd(re_a, re_a, im_a * im_a) + madd(re_b, re_b, im_b * im_b);
  FreeState<T> out;
  const T scale = inverse_sqrt(size2), inverse = scale * scale;
  rotate_and_normalise(re_a, im_a, re_b, im_b, scale, passage.sine, passage.cosine, out);

  T V = T(0.0), Wp = E, Wm = E;
  for (int i = 2; i >= 0; --i) {
    const T uu = u[i] * u[i], dd = d[i] * d[i], cross = madd(u[i + 1], u[i], d[i + 1] * d[i]);
    V = i % 2 ? V - (uu - dd) : V + (uu - dd);
    Wp = Wp + cross;
    Wm = i % 2 ? Wm + cross : Wm - cross;  // (-1)^n of n = i + 1
  }
  const T factor[3] = {flip * Wm, flip * sign * V, Wp};
  for (int i = 0; i < 3; ++i) out.omega[i] = T(body.omega[i]) * factor[i] * inverse;
  return out;
}

template <class T, class C>
POLHODE_INLINE FreeState<T> evaluate(const FreeHyper<C>& body, T t) {
  return evaluate(body, evaluate_passage(body, t));
}

template <class T, class C>
POLHODE_INLINE FreeState<T> evaluate(const FreeHyper<C>& body, T t, T t_low) {
  return evaluate(body, evaluate_passage(body, t, t_low));
}

}  // namespace polhode::exact
