#pragma once

#include <cstddef>

#include "polhode/exact/detail/free_setup_hyper.hpp"

// The derivatives of a free motion with respect to omega(0) and the principal moments, in the working axes of
// FreeConstants. docs/sensitivity.md derives the formulas; I and C are the integrals of sd^2 and cn^2 from u0 to u.
namespace polhode::exact {

/// What the column of one moment J_i needs, at fixed omega(0).
template <class T>
struct MomentColumn {
  T mu, mu_start, rate, of_I;  ///< Y = mu_start + rate w - of_I I
  T rho_G, of_cn2, of_sn2, of_difference;
  T psi;                       ///< psi = psi_factor (cn0^2 t - C / p)
};

/// What the columns of one direction of omega(0) need: dm(0) = J e.
template <class T>
struct RateColumn {
  T x, U, U_w, U_I, P, Q, R;
  T psi;        ///< the angle about the angular momentum, a second
  T dL_x, dL_y;  ///< the change of the angular momentum in the space frame of the series
};

/// Constants of the columns of one body.
template <class T>
struct FreeColumns {
  T p, p_inverse, k2, kc2, kap, root_r_inverse;
  T cn_of, sn_of, dn_of;  ///< Jacobi's functions from the components of omega: cn = cn_of omega1 and so on
  T cn0, sn0, steady;     ///< steady is 1 where the amplitude of m1 is zero
  T La1, La3, L, J[3];
  RateColumn<T> rates[3];
  MomentColumn<T> moments[3];

  // The integrals: I = lin w + osc(z) - osc(z0), and for k^2 > 0.97 also whole periods.
  T lin, osc, osc_start, osc_cn_start;
  T above_even[3], above_odd[2], below_even[3], below_odd[2];       ///< the theta quotient, in cos^2 2z
  T period, nome, nome_over_kc2, u_of_v, K;              ///< k^2 > 0.97
  T passage_start, passages_cn_start, u_start, u_cn_start;  ///< k^2 > 0.97
};

/// G of the moments' columns, and the common part of the set-up.
template <class T>
POLHODE_INLINE void set_up_columns(const FreeConstants<T>& f, FreeColumns<T>& c) {
  using namespace math;
  using N = DoubleDouble<T>;
  const T zero(0.0), one(1.0);
  const auto& s = f.start;
  const auto steady = f.La1.hi == zero;
  const N La1 = select(steady, N(1.0), f.La1), La3 = select(f.La3.hi == zero, N(1.0), f.La3);
  const N root_r = sqrt(f.r), r = f.r;
  const N cn0 = select(steady, N(1.0), f.m[0] / La1), sn0 = select(steady, N(0.0), root_r * f.m[1] / La1);
  const N dn0 = select(f.La3.hi == zero, N(1.0), f.m[2] / La3);
  const N k2 = f.k * f.k, kc2 = f.kc * f.kc;
  const N c1 = f.La1 / La3, rho = c1 * c1, kap = c1 * f.r12 / r;
  const N sn02 = sn0 * sn0, cn02 = cn0 * cn0, dn02 = dn0 * dn0;
  const N J[3] = {N(s.I[0]), N(s.I[1]), N(s.I[2])};

  c.p = f.p.hi, c.p_inverse = select(f.p.hi == zero, zero, (N(1.0) / select(f.p.hi == zero, N(1.0), f.p)).hi);
  c.k2 = k2.hi, c.kc2 = kc2.hi, c.kap = kap.hi, c.root_r_inverse = (one / root_r).hi;
  c.cn_of = select(steady, zero, (J[0] / La1).hi);
  c.sn_of = select(steady, zero, (J[1] * root_r / La1).hi);
  c.dn_of = (J[2] / La3).hi;
  c.cn0 = cn0.hi, c.sn0 = sn0.hi, c.steady = select(steady, one, zero);
  c.La1 = f.La1.hi, c.La3 = f.La3.hi, c.L = f.L.hi;

  const N root_r_sn0 = root_r * sn0;
  for (int a = 0; a < 3; ++a) {
    c.J[a] = s.I[a];
    c.rates[a] = {zero, zero, zero, zero, zero, zero, zero, (f.m[a] / f.L).hi, zero, zero};
  }
  c.rates[0].x = (cn0 * J[0]).hi, c.rates[1].x = (root_r_sn0 * J[1]).hi;
  c.rates[0].U = -(sn0 / dn0 * J[0]).hi, c.rates[1].U = (root_r * cn0 / dn0 * J[1]).hi;
  c.rates[1].U_w = (c1 * kap * root_r_sn0 * J[1]).hi, c.rates[2].U_w = (c1 * dn0 * J[2]).hi;
  c.rates[0].U_I = (k2 * cn0 * J[0]).hi;
  c.rates[1].U_I = (k2 * kc2 * root_r_sn0 * J[1]).hi;
  c.rates[2].U_I = -(k2 * c1 * dn0 * J[2]).hi;
  c.rates[2].P = (dn0 * J[2]).hi, c.rates[1].Q = (kap * root_r_sn0 * J[1]).hi, c.rates[0].R = (kap * cn0 * J[0]).hi;

  // 1 / J2 - 1 / J3 and so on, all of the sign of p; where one is zero, |p t| is small and the power series is used.
  const N gap21 = two_diff(s.I[1], s.I[0]), gap32 = two_diff(s.I[2], s.I[1]), gap31 = two_diff(s.I[2], s.I[0]);
  const N D1 = gap32 / (J[1] * J[2]), D2 = gap31 / (J[0] * J[2]), D3 = gap21 / (J[0] * J[1]);
  const auto flat1 = D1.hi == zero, flat2 = D2.hi == zero;
  const N D1s = select(flat1, N(1.0), D1), D2s = select(flat2, N(1.0), D2);
  const N gap32s = select(flat1, N(1.0), gap32), gap31s = select(flat2, N(1.0), gap31);
  const N half(0.5);
  const N G[3] = {half / (J[0] * J[0] * D2s), -(half / (J[1] * J[1] * D1s)), half * D3 / (J[2] * J[2] * D1s * D2s)};
  const N rate[3] = {-G[0], G[1] + k2 * sn02 / J[1],
                     half * (N(1.0) / gap32s + N(1.0) / gap31s) - k2 * sn02 / J[2]};
  const N hx[3] = {k2 * cn02 / J[0], k2 * kc2 * sn02 / J[1], -(k2 * dn02 / J[2])};
  const N mu[3] = {G[0] - one / J[0], G[1] + one / J[1], G[2]};
  const N of_cn2[3] = {N(0.0), k2 * sn02 / J[1], N(0.0)}, of_sn2[3] = {-(k2 * cn02 / J[0]), N(0.0), N(0.0)};
  const N f_psi[3] = {N(1.0), -(one / r), f.r12 / r};
  for (int i = 0; i < 3; ++i) {
    const N h = -(G[i] * (k2 * cn02 + rho * dn02));
    MomentColumn<T>& m = c.moments[i];
    m.mu = mu[i].hi;
    m.mu_start = (mu[i] * cn0 * sn0 / dn0).hi;
    m.rate = (rate[i] - rho * sn02 * G[i]).hi;
    m.of_I = (h + hx[i]).hi;
    m.rho_G = (rho * sn02 * G[i]).hi;
    m.of_cn2 = of_cn2[i].hi, m.of_sn2 = (of_sn2[i] - h).hi;
    m.of_difference = i == 2 ? (k2 / J[2]).hi : zero;
    m.psi = (f.La1 * f.La1 * f_psi[i] * half / (J[i] * J[i] * f.L)).hi;
  }
}

/// The theta quotient of the integrals in cos 2z, split by parity: for C the argument is a quarter period behind.
template <class T>
POLHODE_INLINE void set_up_integrals_trig(const FreeConstants<T>& f, FreeColumns<T>& c) {
  using namespace math;
  using N = DoubleDouble<T>;
  const N k2 = f.k * f.k, kc2 = f.kc * f.kc;
  // sigma = sum 2^(n-1) c_n^2 / k^2 of the arithmetic-geometric mean of 1 and k'; DLMF 19.8.6.
  N a(1.0), b = f.kc, ratio(1.0), c2 = k2, sigma(0.5);
  T weight(1.0);
  for (int n = 0; n < 5; ++n) {
    const N mean = scaled(plus(a, b), T(0.5));
    b = sqrt(a * b);
    a = mean;
    const N factor = c2 / (scaled(a * a, T(16.0)));
    ratio = ratio * factor;
    c2 = c2 * factor;
    sigma = plus(sigma, scaled(ratio, weight));
    weight = weight + weight;
  }
  c.lin = ((T(1.0) - sigma) / kc2).hi;

  const LandenChain<N> chain(f.k, f.kc);
  const N safe = select(f.k.hi < T(1e-140), N(1e-140), f.k);
  // The nome over k^2; below k = 1e-140 its limit 1/16.
  const N q_over_k2 = select(f.k.hi < T(1e-140), N(0.0625), chain.nome() / (safe * safe));
  c.osc = (scaled(q_over_k2, T(-4.0)) / (kc2 * chain.two_K_over_pi())).hi;

  // sum n q^(n^2 - 1) sin 2nz = sin 2z (even + cos 2z odd); theta3 alike.
  const T q = (q_over_k2 * k2).hi, q2 = q * q, q3 = q2 * q, q4 = q2 * q2, q8 = q4 * q4, q9 = q8 * q, q15 = q8 * q4 * q3;
  const T q16 = q8 * q8, q24 = q16 * q8;
  const T n2 = T(2.0) * q3, n3 = T(3.0) * q8, n4 = T(4.0) * q15, n5 = T(5.0) * q24;
  // sin 2nz / sin 2z: 1, 2x, 4x^2 - 1, 8x^3 - 4x, 16x^4 - 12x^2 + 1
  c.above_even[0] = T(1.0) - n3 + n5, c.above_even[1] = T(4.0) * n3 - T(12.0) * n5, c.above_even[2] = T(16.0) * n5;
  c.above_odd[0] = T(2.0) * n2 - T(4.0) * n4, c.above_odd[1] = T(8.0) * n4;
  // cos 2nz: x, 2x^2 - 1, 4x^3 - 3x, 8x^4 - 8x^2 + 1
  const T t1 = T(2.0) * q, t2 = T(2.0) * q4, t3 = T(2.0) * q9, t4 = T(2.0) * q16;
  c.below_even[0] = T(1.0) - t2 + t4, c.below_even[1] = T(2.0) * t2 - T(8.0) * t4, c.below_even[2] = T(8.0) * t4;
  c.below_odd[0] = t1 - T(3.0) * t3, c.below_odd[1] = T(4.0) * t3;
}

/// osc(z), and osc(z - pi/2) times k'^2.
template <class T>
struct Oscillation {
  T of_sd, of_cn;
};

template <class T, class C>
POLHODE_INLINE Oscillation<T> oscillate(const FreeColumns<C>& c, T sin2z, T cos2z) {
  const T x2 = cos2z * cos2z;
  const T ae = polynomial(c.above_even, x2), ao = cos2z * polynomial(c.above_odd, x2);
  const T be = polynomial(c.below_even, x2), bo = cos2z * polynomial(c.below_odd, x2);
  const T scale = T(c.osc) * sin2z;
  return {scale * (ae + ao) / (be + bo), -(T(c.kc2) * scale) * (ae - ao) / (be - bo)};
}

template <class T>
struct Integrals {
  T w, I, C_over_p;  ///< u - u0, the integral of sd^2, and that of cn^2 over p
};

template <class T, class C>
POLHODE_INLINE Integrals<T> integrate_trig(const FreeColumns<C>& c, T t, T sin_phi, T cos_phi) {
  // z = phi + pi/2
  const T sin2z = T(-2.0) * sin_phi * cos_phi, cos2z = (sin_phi - cos_phi) * (sin_phi + cos_phi);
  const Oscillation<T> osc = oscillate(c, sin2z, cos2z);
  const T w = T(c.p) * t;
  const T C_integral = madd(T(c.kc2) * T(c.lin), w, osc.of_cn - T(c.osc_cn_start));
  return {w, madd(T(c.lin), w, osc.of_sd - T(c.osc_start)), C_integral * T(c.p_inverse)};
}

}  // namespace polhode::exact
