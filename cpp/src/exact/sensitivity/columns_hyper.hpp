#pragma once

#include "exact/sensitivity/columns.hpp"

// The integrals of sd^2 and cn^2 for k^2 > 0.97, in the nome q' of the complementary modulus.
namespace polhode::exact {

/// What the quotients need at v: e^-2|v| and q' e^2|v|, both at most 1.
template <class T>
struct Ends {
  T a, g;
};

template <class T>
POLHODE_INLINE Ends<T> ends_at(T E, T nome) {
  const T a = E * E;
  return {a, select(nome < T(1e-290), T(0.0), nome / a)};
}

/// sum_{n>=1} q'^(n^2-n) n/2 (first g^(n-1) - second l^(n-1)) / (1 + sum q'^(n^2-n) (g^n + l^n)), l = q' a.
/// With first = e^2|v| and second = e^-2|v| it is sum n q'^(n^2-1) sinh 2n|v| / (1 + 2 sum q'^(n^2) cosh 2n|v|).
template <class T>
POLHODE_INLINE T quotient(T first, T second, T g, T l, T nome) {
  const T q2 = nome * nome, q6 = q2 * q2 * q2, h2 = q2, h3 = T(1.5) * q6;
  const T above = madd(first, madd(g, madd(g, h3, h2), T(0.5)), -(second * madd(l, madd(l, h3, h2), T(0.5))));
  const T below = madd(g, madd(g, q2, T(1.0)), madd(l, madd(l, q2, T(1.0)), T(1.0)));
  return above / below;
}

/// The half periods, and the two integrals apart from their start.
template <class T>
struct PassageIntegrals {
  T passages, u, u_cn, osc_sd, osc_cn;  ///< u less whole half periods, for I and for C
  T passages_cn;
};

template <class T, class C>
POLHODE_INLINE PassageIntegrals<T> integrate_passage(const FreeColumns<C>& c, T v, T E, T passages) {
  using namespace math;
  const T side = copysign(T(1.0), v), nome = T(c.nome);
  const Ends<T> e = ends_at(E, nome);
  PassageIntegrals<T> out;
  out.passages = passages;
  out.u = v * T(c.u_of_v);
  out.osc_sd = side * T(c.osc) * T(c.nome_over_kc2) * quotient(T(1.0) / e.a, e.a, e.g, nome * e.a, nome);
  // A quarter period behind, e^-2|v| and q' e^2|v| change their places. C has the factor k'^2.
  out.osc_cn = -(side * T(c.osc) * quotient(e.a, nome * e.g, e.a, nome * e.g, nome));
  out.u_cn = out.u - side * T(c.K);
  out.passages_cn = select(v < T(0.0), passages - T(1.0), passages);
  return out;
}

/// The count of half periods since t = 0, as in evaluate_passage.
template <class T, class C>
POLHODE_INLINE T count_passages(const FreeHyper<C>& body, T t) {
  const auto p = two_prod(t, T(body.rate_hi));
  const T n = rint(p.hi);
  const auto half_cycles = DoubleDouble<T>(two_sum(p.hi - n, madd(t, T(body.rate_lo), p.lo))) +
                           DoubleDouble<T>(T(body.start_hi), T(body.start_lo));
  return n + rint(half_cycles.hi);
}

template <class T, class C>
POLHODE_INLINE Integrals<T> integrate_hyper(const FreeColumns<C>& c, const FreeHyper<C>& body, T t,
                                            const FreePassage<T>& passage, T cn) {
  using namespace math;
  const T w = T(c.p) * t;
  const PassageIntegrals<T> now = integrate_passage(c, passage.v, passage.E, count_passages(body, t));
  const T sd2 = madd(T(c.lin), now.u - T(c.u_start), now.osc_sd - T(c.osc_start)) +
                (now.passages - T(c.passage_start)) * T(c.period);
  if (c.kc2 == C(0.0)) {
    // Exactly on the separatrix C = sinh(w) cn cn0.
    const T size = abs(w), E = math::exp_minus(size);
    const T sinh_w = copysign(T(0.5), w) * (T(1.0) / E - E);
    return {w, sd2, sinh_w * cn * T(c.cn0) * T(c.p_inverse)};
  }
  const T cn2 = T(c.kc2) * madd(T(c.lin), now.u_cn - T(c.u_cn_start),
                                (now.passages_cn - T(c.passages_cn_start)) * T(c.period)) +
                (now.osc_cn - T(c.osc_cn_start));
  return {w, sd2, cn2 * T(c.p_inverse)};
}


template <class T>
inline void set_up_integrals_hyper(const FreeConstants<T>& f, const FreeHyper<T>& body, FreeColumns<T>& c) {
  using namespace math;
  using N = DoubleDouble<T>;
  const T zero(0.0);
  const auto homoclinic = f.kc.hi == zero;
  const N k2 = f.k * f.k, kc2 = f.kc * f.kc;
  N a(1.0), b = f.k, ratio(1.0), c2 = kc2, sigma(0.0);
  T weight(1.0);
  for (int n = 0; n < 5; ++n) {
    const N mean = half(plus(a, b));
    b = sqrt(a * b);
    a = mean;
    const N factor = c2 / scaled(a * a, T(16.0));
    ratio = ratio * factor;
    c2 = c2 * factor;
    sigma = plus(sigma, scaled(ratio, weight));
    weight = weight + weight;
  }
  const N lin = (sigma - N(0.5)) / k2;
  const LandenChain<N> chain(f.kc, f.k);
  const N two_Kc_over_pi = chain.two_K_over_pi();
  const N safe = select(f.kc.hi < T(1e-140), N(1e-140), f.kc);
  const N ratio_q = select(f.kc.hi < T(1e-140), N(0.0625), chain.nome() / (safe * safe));
  const N K = scaled(pi<N>(), T(0.5)) / agm(select(homoclinic, N(1.0), f.kc));
  const N kc2s = select(homoclinic, N(1.0), kc2);
  c.lin = lin.hi;
  c.osc = (N(4.0) / (k2 * two_Kc_over_pi)).hi;
  c.nome = body.q, c.nome_over_kc2 = ratio_q.hi;
  c.u_of_v = two_Kc_over_pi.hi;
  c.K = select(homoclinic, zero, K.hi);
  c.period = select(homoclinic, zero,
                    (N(2.0) / (k2 * kc2s) * (N(1.0) / two_Kc_over_pi + kc2 * (sigma - N(0.5)) * K)).hi);
  const FreePassage<T> passage = evaluate_passage(body, zero);
  const PassageIntegrals<T> start = integrate_passage(c, passage.v, passage.E, count_passages(body, zero));
  c.osc_start = start.osc_sd, c.osc_cn_start = start.osc_cn;
  c.u_start = start.u, c.u_cn_start = start.u_cn;
  c.passage_start = start.passages, c.passages_cn_start = start.passages_cn;
}

}  // namespace polhode::exact
