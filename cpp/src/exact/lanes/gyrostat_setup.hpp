#pragma once

#include "exact/lanes/gyrostat_roots.hpp"
#include "exact/lanes/gyrostat_theta.hpp"
#include "polhode/exact/detail/gyrostat_series.hpp"

// The constants of a gyrostat's series, all in double-double. Names follow docs/gyrostat.md.
namespace polhode::POLHODE_ISA::gyrostat {

using Pair = Complex<DD>[2];

inline Complex<DD> cross(const Pair& a, const Pair& b) { return a[0] * b[1] - a[1] * b[0]; }

/// The eigenvector of an invariant: (n, v) with n.n - v^2 = nn, and how far nn is from cancelling.
struct Eigenvector {
  DD n[3], v, nn;
  double cond;

  Eigenvector(const Form& f, const Root& root) {
    const int i = root.pole;
    if (root.mu.hi == 0.0 && !f.has_rotor[i]) {
      n[i] = DD(1.0);
    } else {
      n[i] = -f.g[i];
      for (int j = 0; j < 3; ++j)
        if (j != i) n[j] = root.mu * f.g[j] / (f.apart[j][i] - root.mu);
      v = root.mu * f.L;
    }
    double largest = math::abs(v.hi);
    for (const DD& c : n) largest = math::max(largest, math::abs(c.hi));
    const double unit = math::power_of_two_below(largest);
    for (DD& c : n) c = divided(c, unit);
    v = divided(v, unit);
    const DD space = squared(n[0]) + squared(n[1]) + squared(n[2]);
    nn = space - squared(v);
    cond = math::abs(nn.hi) / (space + squared(v)).hi;
  }
};

/// The modulus and the rate of the theta functions, and the pair of invariants that spans their axis.
struct Pairing {
  DD Sm, Df2, SW, nome;
  int a = 0, b = 0;

  Pairing(const Form& f, const Roots& roots, const Eigenvector* vectors) {
    const Root* r = roots.real;
    if (roots.pair) {
      const DD ra = r[0].x, rb = r[1].x;
      Sm = math::twice(roots.ga + ra * rb) + roots.be * (ra + rb);
      Df2 = roots.D * squared(difference(f, r[0], r[1]));
      a = 0, b = 1;
      if (roots.touch && Sm.hi < 0.0) Df2 = DD(0.0);
      finish();
      return;
    }
    const auto gap = [&](int i, int j) { return difference(f, r[j], r[i]); };
    const DD inner = gap(0, 1) * gap(2, 3), outer = gap(0, 3) * gap(1, 2), across = gap(0, 2) * gap(1, 3);
    Sm = across + outer, Df2 = squared(inner);
    choose(vectors, 0, 1, 2, 3);
    finish();
    if (nome.hi <= 0.0433) return;
    Sm = -(inner + across), Df2 = roots.touch ? DD(0.0) : squared(outer);
    choose(vectors, 0, 3, 1, 2);
    finish();
  }

 private:
  void choose(const Eigenvector* v, int i, int j, int k, int l) {
    const bool first = math::min(v[i].cond, v[j].cond) >= math::min(v[k].cond, v[l].cond);
    a = first ? i : k, b = first ? j : l;
  }
  /// The nome by the series of theta constants (Weierstrass; DLMF 20.9, 22.2), with its relative accuracy.
  void finish() {
    SW = math::scaled(math::abs(Sm) + root_of(squared(Sm) - Df2), 0.5);
    const DD mm = Df2 / math::scaled(squared(SW), 4.0), kc = math::sqrt(DD(1.0) - mm);
    const DD e = math::scaled(mm / ((DD(1.0) + kc) * squared(DD(1.0) + math::sqrt(kc))), 0.5);
    const DD e4 = squared(squared(e));
    constexpr double c[] = {1.0, 2.0, 15.0, 150.0, 1707.0, 20910.0, 268616.0};
    DD sum(c[6]);
    for (int i = 5; i >= 0; --i) sum = sum * e4 + DD(c[i]);
    nome = e * sum;
  }
};

/// Minus the determinant of the quadratic form of energy where b spans the spinors, by the Binet-Cauchy formula: of its
/// minors only those are left that do not cancel for a needle.
inline Complex<DD> discriminant(const Form& f, const Pair& b) {
  const Complex<DD> p = b[0] * b[0], q = b[1] * b[1], pq = b[0] * b[1];
  const Complex<DD> N[3] = {q - p, -times_i(p + q), pq + pq};  // N . N = 0
  DD shift(0.0);
  for (int i = 0; i < 3; ++i) shift = shift + f.g[i] * f.m[i];
  shift = shift / f.L;
  DD a[3];
  for (int i = 0; i < 3; ++i) a[i] = (f.A[i] - f.sg) + shift;
  Complex<DD> squares{DD(0.0), DD(0.0)}, along = squares, mixed = squares;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    squares = squares + (a[j] * a[k]) * (N[i] * N[i]);
    if (!f.has_rotor[i]) continue;
    along = along + f.g[i] * N[i];
    mixed = mixed + (f.g[i] * f.apart[j][k]) * (N[j] * N[k]);
  }
  return squared(f.L) * squares + along * along - math::twice(f.L) * times_i(mixed);
}

/// psi of the direction m: m1 + i m2 = 2 conj(psi1) psi2, m3 = |psi1|^2 - |psi2|^2.
inline void set_spinor(const DD (&m)[3], Pair& psi) {
  const DD half = math::scaled(DD(1.0) + math::abs(m[2]), 0.5), large = math::sqrt(half);
  const DD scale = DD(0.5) / large;
  const bool up = m[2].hi >= 0.0;
  psi[up ? 0 : 1] = {large, DD(0.0)};
  psi[up ? 1 : 0] = {m[0] * scale, up ? m[1] * scale : -(m[1] * scale)};
}

/// psi' = (i/2) (omega . sigma) psi.
inline void set_slope(const DD (&w)[3], const Pair& psi, Pair& slope) {
  const Complex<DD> plus{w[0], w[1]};
  slope[0] = DD(0.5) * times_i(w[2] * psi[0] + conj(plus) * psi[1]);
  slope[1] = DD(0.5) * times_i(plus * psi[0] - w[2] * psi[1]);
}

/// What the series needs: psi = e^{i kappa t} (E(w) bE + O(w) bO), with x = e^{iw} at the start.
struct Solution {
  bool trig = true;
  DD nome, nu, kappa;   ///< nu: of phi, or (hyper) of -v
  Complex<DD> x;
  Pair bE, bO;
};

inline Solution solve(const Form& f, const Pairing& pairing, const Eigenvector& na, const Eigenvector& nb) {
  Solution s;
  s.nome = pairing.nome;
  s.trig = pairing.Sm.hi >= 0.0;
  const Theta<DD> zero(pairing.nome, {DD(1.0), DD(0.0)});
  const DD tE = zero.E.re, tO = zero.O.re;
  s.nu = f.L * root_of(math::scaled(pairing.SW, 0.5)) / squared(tE);
  const DD nu2 = s.trig ? squared(s.nu) : -squared(s.nu);

  // The axis rho of the two theta functions among the complex directions; its square is nn_a nn_b.
  const DD square = na.nn * nb.nn, size = root_of(math::abs(square));
  Complex<DD> rho[3];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const DD re = na.n[j] * nb.n[k] - na.n[k] * nb.n[j], im = -(na.v * nb.n[i] - nb.v * na.n[i]);
    rho[i] = square.hi > 0.0 ? Complex<DD>{re / size, im / size} : Complex<DD>{im / size, -re / size};
  }
  if (rho[2].re.hi < 0.0)
    for (Complex<DD>& c : rho) c = -c;
  const Complex<DD> one{DD(1.0), DD(0.0)}, along = one + rho[2];
  const Complex<DD> east = rho[0] + times_i(rho[1]), west = times_i(rho[1]) - rho[0];
  const DD sizeE = root_of(size2(along) + size2(east)), sizeO = root_of(size2(along) + size2(west));
  s.bE[0] = (DD(1.0) / sizeE) * along, s.bE[1] = (DD(1.0) / sizeE) * east;
  s.bO[0] = (DD(1.0) / sizeO) * west, s.bO[1] = (DD(1.0) / sizeO) * along;

  // c0 c4 = L^4 Df2 det^4: only the larger is computed.
  const Complex<DD> det = cross(s.bE, s.bO), det2 = det * det;
  const Complex<DD> product = (squared(squared(f.L)) * pairing.Df2) * (det2 * det2);
  const auto exchange = [&s] {
    const Pair old = {s.bE[0], s.bE[1]};
    for (int i = 0; i < 2; ++i) s.bE[i] = s.bO[i], s.bO[i] = -old[i];
  };
  Complex<DD> c0 = discriminant(f, s.bE);
  const Complex<DD> c4 = discriminant(f, s.bO);
  if (size2(c0).hi < size2(c4).hi) exchange(), c0 = c4;

  Pair psi, slope;
  set_spinor(f.m, psi);
  set_slope(f.start.w, psi, slope);
  const Complex<DD> nu{s.trig ? s.nu : DD(0.0), s.trig ? DD(0.0) : s.nu};
  Complex<DD> scale;
  for (int attempt = 0;; ++attempt) {
    const DD weight = math::scaled(nu2 * squared(tE * tO), 4.0);
    scale = square_root(-(c0 / (weight * det2)));
    const Complex<DD> xE = cross(psi, s.bO) / det, a = cross(s.bE, psi) / (det * scale);
    const Complex<DD> wronskian = cross(psi, slope) / (det * scale * nu);
    s.x = start_of(s.nome, xE, a, wronskian);
    // Far from the real axis the other function leads.
    const double r2 = size2(s.x).hi, r4 = r2 * r2, Q = math::abs(s.nome.hi);
    if (attempt > 0 || !s.trig || (r4 * Q <= 1.0 && Q <= r4)) break;
    exchange();
    c0 = product / c0;
  }
  for (Complex<DD>& c : s.bO) c = scale * c;

  const Theta<DD> theta(s.nome, s.x);
  Pair V, dV;
  for (int i = 0; i < 2; ++i) {
    V[i] = theta.E * s.bE[i] + theta.O * s.bO[i];
    dV[i] = nu * (theta.dE * s.bE[i] + theta.dO * s.bO[i]);
  }
  const Complex<DD> ratio = (conj(psi[0]) * dV[0] + conj(psi[1]) * dV[1]) / (conj(psi[0]) * V[0] + conj(psi[1]) * V[1]);
  s.kappa = math::scaled(f.sg * f.L, 0.5) - ratio.im;
  return s;
}

}  // namespace polhode::POLHODE_ISA::gyrostat
