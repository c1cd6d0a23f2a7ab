#pragma once

#include "polhode/exact/detail/free_setup.hpp"
#include "polhode/math/detail/dd_functions.hpp"

namespace polhode::exact {

template <class T>
POLHODE_INLINE DoubleDouble<T> half(DoubleDouble<T> a) {
  return scaled(a, T(0.5));
}

/// The arithmetic-geometric mean of 1 and x > 0; a fixed number of steps, enough for x >= 1e-300.
template <class N>
POLHODE_INLINE N agm(N x) {
  N a(1.0), b = x;
  for (int i = 0; i < 15; ++i) {
    const N mean = half(plus(a, b));
    b = sqrt(a * b);
    a = mean;
  }
  return a;
}

/// The constants of FreeHyper, for k^2 > 0.97. The argument v0 of the start and eta are in double-double as well,
/// because near the separatrix their errors are magnified by K.
template <class T>
inline FreeHyper<T> set_up_hyper(const FreeConstants<T>& f) {
  using namespace math;
  using N = DoubleDouble<T>;
  const T none(0.0), unity(1.0);
  const N zero(0.0), one(1.0);
  const auto homoclinic = f.kc.hi == none;
  const LandenChain<N> chain(f.kc, f.k);
  const N two_Kc_over_pi = chain.two_K_over_pi();  // 2 K' / pi
  const N q = chain.nome();
  const N v_rate = f.p / two_Kc_over_pi;           // pi p / 2K': dv/dt

  const N root_r = sqrt(f.r);
  const auto eta_xy = descend_real(chain, root_r, sqrt(f.r12), one, sqrt(one - f.kc * f.kc * f.r));
  const N eta = atan2_dd(eta_xy.Y, eta_xy.X);

  const N sn = abs(f.m[1]) * root_r / f.La1, cn = abs(f.m[0]) / f.La1, dn = f.m[2] / f.La3;
  const N distance = -log_dd(descend_imaginary(chain, sn, cn, dn).exp_minus());
  const T side = select(f.m[0].hi < none, -unity, unity) * select(f.m[1].hi < none, -unity, unity);
  const N v0 = scaled(distance, side);

  FreeHyper<T> c;
  c.homoclinic = select(homoclinic, unity, none);
  c.parity0 = select(f.m[0].hi < none, unity, none);
  c.q = q.hi;
  c.eta = (eta / twice(pi<N>())).hi;

  // kappa = psi0/2 - (eta/pi) nu + (dv/dt / 2) sum h_n (2n+1) sin((2n+1) eta/2) / sum h_n cos((2n+1) eta/2)
  const SinCosOf<T> first = sincos_dd(half(eta)), step = sincos_dd(eta);
  N s = first.sin, co = first.cos, h(1.0), qn(1.0), above = zero, below = zero, beside = zero;
  for (int n = 0; n <= 5; ++n) {
    if (n < 4) c.S[n] = s.hi, c.C[n] = co.hi;
    above = above + h * s * T(2.0 * n + 1.0);
    below = below + h * co;
    beside = n % 2 ? beside - h * s : beside + h * s;
    const N next = s * step.cos + co * step.sin;
    co = co * step.cos - s * step.sin;
    s = next;
    qn = qn * q;
    h = h * qn;
  }
  const N psi0 = plus(f.twice_T / f.L, f.La3 / f.start.I[2]) / one_plus(f.a3);
  const N inside = half(psi0 + v_rate * (above / below));

  // Exactly on the separatrix v = v0 + (dv/dt) t for ever, without half cycles.
  const N two_K_over_pi = one / agm(select(homoclinic, one, f.kc));
  const N rate = f.p / (two_K_over_pi * pi<N>());  // nu / pi
  const N v_scale = pi<N>() * two_K_over_pi / two_Kc_over_pi;  // pi^2 / lambda
  const N start = v0 / v_scale;
  const N kappa = select(homoclinic, inside, inside - eta * rate) / twice(pi<N>());
  const N cycle_rate = select(homoclinic, zero, rate), cycle_start = select(homoclinic, zero, start);
  const N v_factor = select(homoclinic, v_rate, v_scale), v_start = select(homoclinic, v0, zero);
  c.rate_hi = cycle_rate.hi, c.rate_lo = cycle_rate.lo;
  c.start_hi = cycle_start.hi, c.start_lo = cycle_start.lo;
  c.v_hi = v_factor.hi, c.v_lo = v_factor.lo;
  c.v0_hi = v_start.hi, c.v0_lo = v_start.lo;
  c.kappa_hi = kappa.hi, c.kappa_lo = kappa.lo;

  // omega: theta functions of q at 0 (t2 without its 2 q^(1/4))
  const N q2 = q * q, q4 = q2 * q2, q9 = q4 * q4 * q;
  const N t2 = one + (q2 + q2 * q4), t3 = one + twice(q + q4 + q9), t4 = one + twice(q4 - q - q9);
  // Their divisor is |alpha|^2 + |beta|^2 up to a constant of the body, from both at v = 0: 2 (below^2 + beside^2) / t2.
  const N size = twice(below * below + beside * beside);
  c.omega[2] = (twice(f.La3) * size / (t3 * f.start.I[2])).hi;
  c.omega[0] = (twice(f.La1) * size / (t4 * f.start.I[0])).hi;
  c.omega[1] = (f.La1 * t3 * size / (root_r * t4 * t2 * f.start.I[1])).hi;
  return c;
}

}  // namespace polhode::exact
