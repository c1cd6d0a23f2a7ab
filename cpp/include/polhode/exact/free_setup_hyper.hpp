#pragma once

#include "polhode/exact/free_setup.hpp"

namespace polhode::exact {

/// The arithmetic-geometric mean of 1 and x > 0; a fixed number of steps, enough for x >= 1e-300.
template <class N>
POLHODE_INLINE N agm(N x) {
  N a(1.0), b = x;
  for (int i = 0; i < 15; ++i) {
    const N mean = scaled(a + b, 0.5);
    b = sqrt(a * b);
    a = mean;
  }
  return a;
}

/// The constants of FreeHyper, for k^2 > 0.97; the start's argument v0 and eta in double-double as well, because
/// near the separatrix their error comes back magnified by K.
inline FreeHyper<double> set_up_hyper(const FreeConstants<double>& f) {
  using namespace math;
  const DD zero(0.0), one(1.0);
  const bool homoclinic = f.kc.hi == 0.0;
  const LandenChain<DD> chain(f.kc, f.k);
  const DD two_Kc_over_pi = chain.two_K_over_pi();  // 2 K' / pi
  const DD q = chain.nome();
  const DD half_rate = f.p / two_Kc_over_pi;        // pi p / 2K': dv/dt

  const auto eta_xy = descend_real(chain, sqrt(f.r), sqrt(f.r12), one, sqrt(one - f.kc * f.kc * f.r));
  const DD eta = atan2(eta_xy.Y, eta_xy.X);

  const DD sn = abs(f.m[1]) * sqrt(f.r) / f.La1, cn = abs(f.m[0]) / f.La1, dn = f.m[2] / f.La3;
  const DD size = -log(descend_imaginary(chain, sn, cn, dn).exp_minus());
  const bool behind = f.m[0].hi < 0.0;
  const DD v0 = (f.m[1].hi < 0.0) != behind ? -size : size;

  FreeHyper<double> c{};
  c.homoclinic = homoclinic ? 1.0 : 0.0;
  c.parity0 = behind ? 1.0 : 0.0;
  c.q = q.hi;
  c.eta = (eta / scaled(pi<DD>(), 2.0)).hi;

  // kappa = psi0/2 - (eta/pi) nu + (dv/dt / 2) sum h_n (2n+1) sin((2n+1) eta/2) / sum h_n cos((2n+1) eta/2)
  const SinCos half = sincos(scaled(eta, 0.5)), step = sincos(eta);
  DD s = half.sin, co = half.cos, h(1.0), qn(1.0), above = zero, below = zero;
  for (int n = 0; n <= 5; ++n) {
    if (n < 4) c.S[n] = s.hi, c.C[n] = co.hi;
    above = above + h * s * DD(2.0 * n + 1.0);
    below = below + h * co;
    const DD next = s * step.cos + co * step.sin;
    co = co * step.cos - s * step.sin;
    s = next;
    qn = qn * q;
    h = h * qn;
  }
  const DD psi0 = (f.twice_T / f.L + f.La3 / f.start.I[2]) / (one + f.a3);
  DD kappa = scaled(psi0 + half_rate * (above / below), 0.5);

  if (homoclinic) {
    // v itself runs for ever: v = v0 + (dv/dt) t, taken out of the turns. Signs of m1 are those of (-1)^N alone.
    c.v_hi = half_rate.hi, c.v_lo = half_rate.lo;
    c.v0_hi = v0.hi, c.v0_lo = v0.lo;
  } else {
    const DD two_K_over_pi = one / agm(f.kc);
    const DD nu = f.p / two_K_over_pi;                   // of z = pi u / 2K
    const DD lambda = pi<DD>() * two_Kc_over_pi / two_K_over_pi;
    const DD rate = nu / pi<DD>(), start = lambda * v0 / (pi<DD>() * pi<DD>());
    const DD v_scale = pi<DD>() * pi<DD>() / lambda;
    kappa = kappa - eta * rate;
    c.rate_hi = rate.hi, c.rate_lo = rate.lo;
    c.start_hi = start.hi, c.start_lo = start.lo;
    c.v_hi = v_scale.hi, c.v_lo = v_scale.lo;
  }
  kappa = kappa / scaled(pi<DD>(), 2.0);
  c.kappa_hi = kappa.hi, c.kappa_lo = kappa.lo;

  // omega: theta functions of q at 0 (t2 without its 2 q^(1/4))
  const DD q2 = q * q, q4 = q2 * q2, q9 = q4 * q4 * q;
  const DD t2 = one + q2 + q2 * q4, t3 = one + scaled(q + q4 + q9, 2.0), t4 = one + scaled(q4 - q - q9, 2.0);
  const DD La2 = f.La1 / sqrt(f.r);
  c.omega3 = (scaled(f.La3, 2.0) * t2 / t3 / f.start.I[2]).hi;
  c.omega1 = (scaled(f.La1, 2.0) * t2 / t4 / f.start.I[0]).hi;
  c.omega2 = (La2 * t3 / t4 / f.start.I[1]).hi;
  return c;
}

}  // namespace polhode::exact
