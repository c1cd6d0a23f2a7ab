#pragma once

#include "exact/lanes/gyrostat_setup.hpp"

// The coefficients of the spinor and of the rates, rounded once.
namespace polhode::POLHODE_ISA::gyrostat {

using exact::GyrostatSeries;
using exact::PhasePolynomials;

/// Fills hi and lo from a rate or an angle in radians, in cycles.
inline void set_cycles(double& hi, double& lo, DD angle) {
  const DD cycles = angle / math::twice(math::pi<DD>());
  hi = cycles.hi, lo = cycles.lo;
}

/// The polynomials of degree m with cos 2m phi = T_m, sin 2m phi = sin 2 phi U_{m-1}, cos (2m+1) phi = cos phi V_m,
/// sin (2m+1) phi = sin phi W_m in X = cos 2 phi: F_{m+1} = 2 X F_m - F_{m-1}, F_0 = 1, F_1 = first + slope X.
template <int n>
inline void expand(const DD (&weight)[n], double first, double slope, double (&monomials)[n]) {
  double before[n] = {}, now[n] = {};
  DD sum[n];
  now[0] = 1.0;
  for (int m = 0; m < n; ++m) {
    for (int i = 0; i <= m; ++i) sum[i] = sum[i] + now[i] * weight[m];
    double next[n] = {};
    for (int i = 0; i < n; ++i) {
      next[i] = m == 0 ? first * now[i] : -before[i];
      if (i > 0) next[i] += (m == 0 ? slope : 2.0) * now[i - 1];
    }
    for (int i = 0; i < n; ++i) before[i] = now[i], now[i] = next[i];
  }
  for (int i = 0; i < n; ++i) monomials[i] = sum[i].hi;
}

/// One real function from the weights of cos n phi and sin n phi, n = 0 ... 2 even - 1.
template <int even, int odd>
inline void set_polynomials(PhasePolynomials<even, odd>& p, const DD* cosine, const DD* sine) {
  DD ec[even], es[even - 1], oc[odd], os[odd];
  for (int m = 0; m < even; ++m) ec[m] = cosine[2 * m];
  for (int m = 1; m < even; ++m) es[m - 1] = sine[2 * m];
  for (int m = 0; m < odd; ++m) oc[m] = cosine[2 * m + 1], os[m] = sine[2 * m + 1];
  expand(ec, 0.0, 1.0, p.even_cos);
  expand(es, 0.0, 2.0, p.even_sin);
  expand(oc, -1.0, 2.0, p.odd_cos);
  expand(os, 1.0, 2.0, p.odd_sin);
}

/// alpha = psi1 and beta = -i psi2.
inline void set_parts(const Complex<DD>& psi1, const Complex<DD>& psi2, Complex<DD> (&part)[2]) {
  part[0] = psi1, part[1] = -times_i(psi2);
}

/// The Hermitian forms whose values on psi are J_i omega_i |psi|^2 over J_i, between the vectors of the even and the
/// odd powers: (E, E), (O, O) and (O, E).
struct RateForms {
  DD even[3], odd[3];
  Complex<DD> mixed[3];

  RateForms(const Form& f, const Pair& E, const Pair& O) {
    Complex<DD> ee[3], oo[3];
    fill(f, E, E, ee), fill(f, O, O, oo), fill(f, O, E, mixed);
    for (int i = 0; i < 3; ++i) even[i] = ee[i].re, odd[i] = oo[i].re;
  }

 private:
  static void fill(const Form& f, const Pair& left, const Pair& right, Complex<DD> (&out)[3]) {
    const Complex<DD> a = conj(left[0]) * right[0], b = conj(left[1]) * right[1];
    const Complex<DD> p = conj(left[0]) * right[1], q = conj(left[1]) * right[0];
    const Complex<DD> sigma[3] = {p + q, times_i(q - p), a - b};
    for (int i = 0; i < 3; ++i) out[i] = f.A[i] * (f.L * sigma[i] - f.start.h[i] * (a + b));
  }
};

/// floor(j^2 / 4): k^2 of j = 2k, k^2 + k of j = 2k + 1.
constexpr int nome_power(int j) { return (j * j - (j & 1)) / 4; }

/// The trigonometric series from the coefficients c_j of e^{ij phi} before bE (even j) and bO (odd j).
inline void set_trig(GyrostatSeries& out, const Form& f, const Complex<DD>* c, const Pair& bE, const Pair& bO) {
  constexpr int J = exact::gyrostat_trig_terms, R = exact::gyrostat_trig_rates;
  Complex<DD> up[2][J + 1], down[2][J + 1];
  for (int j = 0; j <= J; ++j) {
    const Pair& b = j % 2 ? bO : bE;
    const Complex<DD> plus = c[j], minus = c[-j];
    Complex<DD> part[2];
    set_parts(plus * b[0], plus * b[1], part);
    up[0][j] = part[0], up[1][j] = part[1];
    set_parts(minus * b[0], minus * b[1], part);
    down[0][j] = part[0], down[1][j] = part[1];
  }
  for (int i = 0; i < 2; ++i) {
    DD re_cos[J + 1], re_sin[J + 1], im_cos[J + 1], im_sin[J + 1];
    re_cos[0] = up[i][0].re, im_cos[0] = up[i][0].im;
    for (int j = 1; j <= J; ++j) {
      re_cos[j] = up[i][j].re + down[i][j].re, im_cos[j] = up[i][j].im + down[i][j].im;
      re_sin[j] = down[i][j].im - up[i][j].im, im_sin[j] = up[i][j].re - down[i][j].re;
    }
    set_polynomials(out.spinor[2 * i], re_cos, re_sin);
    set_polynomials(out.spinor[2 * i + 1], im_cos, im_sin);
  }

  double size_of[2 * J + 1], most = 0.0;
  double* const sizes = size_of + J;
  for (int j = -J; j <= J; ++j) sizes[j] = largest(c[j]), most = math::max(most, sizes[j] * sizes[j]);
  const RateForms forms(f, bE, bO);
  DD cosine[3][R + 2], sine[3][R + 2];
  for (int n = 0; n <= R; ++n) {
    Complex<DD> same[2], cross[2];  // of (E, E), (O, O); of c_even conj(c_odd), c_odd conj(c_even)
    for (int k = -J; k + n <= J; ++k) {
      const Complex<DD> a = c[k + n], b = c[k];
      if (sizes[k + n] * sizes[k] <= 1e-35 * most) continue;
      Complex<DD>& sum = n % 2 ? cross[k & 1 ? 0 : 1] : same[k & 1];
      sum = sum + a * conj(b);
    }
    for (int i = 0; i < 3; ++i) {
      Complex<DD> value;
      if (n % 2) {
        value = cross[0] * forms.mixed[i] + cross[1] * conj(forms.mixed[i]);
      } else {
        value = forms.even[i] * same[0] + forms.odd[i] * same[1];
      }
      cosine[i][n] = n == 0 ? value.re : math::twice(value.re);
      sine[i][n] = -math::twice(value.im);
    }
  }
  for (int i = 0; i < 3; ++i) set_polynomials(out.rate[i], cosine[i], sine[i]);
}

/// The hyperbolic series: e^v = e^(-i w) but for its constant phase, e = x / |x|.
inline void set_hyper(GyrostatSeries& out, const Form& f, const Solution& s) {
  constexpr int J = exact::gyrostat_hyper_terms, R = exact::gyrostat_hyper_rates;
  constexpr int most = 2 * nome_power(J) + 1;
  const DD Q = math::abs(s.nome), size = norm(s.x);
  const Complex<DD> e = (DD(1.0) / size) * s.x;
  DD power[most];  // |Q|^n
  power[0] = DD(1.0);
  for (int n = 1; n < most; ++n) power[n] = power[n - 1].hi > 1e-40 ? power[n - 1] * Q : DD(0.0);
  const auto weight = [&](int n, int brought) {  // Q^n / |Q|^brought
    const DD value = power[n - brought];
    return s.nome.hi < 0.0 && n % 2 ? -value : value;
  };
  Complex<DD> powers[2 * J + 1];  // e^n
  powers[0] = {DD(1.0), DD(0.0)};
  for (int n = 1; n <= 2 * J; ++n) powers[n] = powers[n - 1] * e;
  const auto power_of = [&](int n) { return n < 0 ? conj(powers[-n]) : powers[n]; };

  for (int j = -J; j <= J; ++j) {
    const int far = j < 0 ? -j : j, place = j < 0 ? J - j : j;
    const Pair& b = j % 2 ? s.bO : s.bE;
    const Complex<DD> c = weight(nome_power(far), far > 0 ? far - 1 : 0) * power_of(j);
    Complex<DD> part[2];
    set_parts(c * b[0], c * b[1], part);
    for (int i = 0; i < 2; ++i) {
      out.hyper_spinor[2 * i][place] = part[i].re.hi;
      out.hyper_spinor[2 * i + 1][place] = part[i].im.hi;
    }
  }
  const RateForms forms(f, s.bE, s.bO);
  for (int n = -R; n <= R; ++n) {
    const int far = n < 0 ? -n : n, place = n < 0 ? R - n : n, brought = far > 2 ? far - 2 : 0;
    DD even(0.0), odd(0.0);
    Complex<DD> mixed;
    for (int j = -J; j <= J; ++j) {
      const int k = n - j;
      if (k < -J || k > J || (n % 2 && j % 2)) continue;  // with odd n, j is the even one
      const int raised = nome_power(j) + nome_power(k);
      if (power[raised - brought].hi == 0.0) continue;
      const DD w = weight(raised, brought);
      if (n % 2) {
        mixed = mixed + w * power_of(j - k);
      } else {
        DD& sum = j % 2 ? odd : even;
        sum = sum + w * power_of(j - k).re;
      }
    }
    for (int i = 0; i < 3; ++i) {
      const DD value = n % 2 ? math::twice((mixed * forms.mixed[i]).re) : even * forms.even[i] + odd * forms.odd[i];
      out.hyper_rate[i][place] = value.hi;
    }
  }

  const DD v0 = logarithm_of(size), rate = -s.nu;
  out.hyper = true;
  out.v_start_hi = v0.hi, out.v_start_lo = v0.lo;
  out.v_rate_hi = rate.hi, out.v_rate_lo = rate.lo;
  set_cycles(out.kappa_hi, out.kappa_lo, s.kappa);
  if (Q.hi < 1e-290) return;  // one passage
  const DD passage = -logarithm_of(Q), often = rate / passage;
  out.nome = Q.hi;
  out.v_passage_hi = passage.hi, out.v_passage_lo = passage.lo;
  out.nu_hi = often.hi, out.nu_lo = often.lo;
  out.start = (v0 / passage).hi;
  // The half turn keeps the sign of the quaternion continuous.
  const bool alternates = s.nome.hi < 0.0;
  set_cycles(out.kappa_passage_hi, out.kappa_passage_lo,
             math::twice(angle_of(e)) + (alternates ? math::pi<DD>() : DD(0.0)));
  out.alternates = alternates ? 1.0 : 0.0;
}

/// Constant omega, or omega = lam M + c with c constant in the body: at most two powers.
/// e^{i t (lam L + c . sigma) / 2} splits psi into the two eigenvectors of c . sigma.
inline void set_constant_rates(GyrostatSeries& out, const Form& f, DD lam, const DD (&c)[3], const DD (&m)[3]) {
  const DD size = root_of(squared(c[0]) + squared(c[1]) + squared(c[2]));
  Pair psi, up, down;
  set_spinor(m, psi);
  Complex<DD> weights[2 * exact::gyrostat_trig_terms + 1];
  Complex<DD>* const w = weights + exact::gyrostat_trig_terms;
  const Complex<DD> one{DD(1.0), DD(0.0)};
  DD kappa = math::scaled(lam * f.L, 0.5);
  w[0] = one;
  up[0] = up[1] = down[0] = down[1] = {DD(0.0), DD(0.0)};
  if (size.hi > 0.0) {
    const DD axis[3] = {c[0] / size, c[1] / size, c[2] / size};
    Pair along;
    set_spinor(axis, along);
    const Pair against = {-conj(along[1]), conj(along[0])};
    const Complex<DD> p = conj(along[0]) * psi[0] + conj(along[1]) * psi[1];
    const Complex<DD> q = conj(against[0]) * psi[0] + conj(against[1]) * psi[1];
    for (int i = 0; i < 2; ++i) up[i] = p * along[i], down[i] = q * against[i];
    w[1] = one;
    kappa = kappa - math::scaled(size, 0.5);
    set_cycles(out.nu_hi, out.nu_lo, size);
  } else {
    down[0] = psi[0], down[1] = psi[1];
  }
  set_cycles(out.kappa_hi, out.kappa_lo, kappa);
  set_trig(out, f, w, down, up);
}

}  // namespace polhode::POLHODE_ISA::gyrostat
