#pragma once

#include "exact/lanes/gyrostat_complex.hpp"

// The two theta functions of a gyrostat, |Q| <= 0.0433:
// E(w) = sum Q^(k^2) e^(2ikw), O(w) = sum Q^(k^2+k) e^(i(2k+1)w).
namespace polhode::POLHODE_ISA::gyrostat {

/// The larger part of a, in size.
template <class N>
inline double largest(Complex<N> a) {
  return math::max(math::abs(math::rounded(a.re)), math::abs(math::rounded(a.im)));
}

/// E, O and their derivatives by w, from x = e^{iw}.
template <class N>
struct Theta {
  Complex<N> E, O, dE, dO;

  Theta(N nome, Complex<N> x) {
    constexpr bool wide = sizeof(N) > sizeof(double);
    constexpr int most = wide ? 7 : 5;
    constexpr double least = wide ? 1e-26 : 1e-13;  // the next term is smaller by Q^2 at least
    const Complex<N> one{N(1.0), N(0.0)}, y = one / x;
    const Complex<N> x2 = x * x, y2 = y * y;
    E = one, O = x + y, dE = {N(0.0), N(0.0)}, dO = x - y;
    // The weights are multiplied in before the powers grow.
    Complex<N> up = one, down = one, odd_up = x, odd_down = y;
    N q(1.0);  // Q^(2k - 2)
    for (int k = 1; k <= most; ++k) {
      q = q * nome;  // from Q^(k-1)^2 to Q^(k^2) the factor is Q^(2k-1)
      up = q * (up * x2), down = q * (down * y2);
      q = q * nome;  // from Q^(k^2-k) to Q^(k^2+k) it is Q^(2k)
      odd_up = q * (odd_up * x2), odd_down = q * (odd_down * y2);
      E = E + (up + down), dE = dE + N(2.0 * k) * (up - down);
      O = O + (odd_up + odd_down), dO = dO + N(2.0 * k + 1.0) * (odd_up - odd_down);
      const double last = largest(up) + largest(down) + largest(odd_up) + largest(odd_down);
      if (last <= least * (largest(E) + largest(O))) break;
    }
    dE = times_i(dE), dO = times_i(dO);
  }
};

/// One step of Newton's method for xE O(w) = a E(w), in x = e^{iw}. Returns the relative change.
template <class N>
inline double improve(N nome, Complex<N> xE, Complex<N> a, Complex<N>& x) {
  const Theta<N> f(nome, x);
  const Complex<N> step = (xE * f.O - a * f.E) / (xE * f.dO - a * f.dE);
  const double size = math::sqrt(math::rounded(size2(step)));
  if (!(size < 1e100)) return 0.0;
  x = x - times_i(x * step);
  return size;
}

/// e^{iw} at the start: xE O(w) = a E(w), of the two signs of w the one with the given Wronskian.
inline Complex<DD> start_of(DD nome, Complex<DD> xE, Complex<DD> a, Complex<DD> wronskian) {
  using C = Complex<double>;
  const double Q = nome.hi;
  const C e = rounded(xE), b = rounded(a);
  // Q^2 is left out: xE cos w' = a (1 - 2Q + 4Q cos^2 w') / 2.
  const C inside = e * e - (4.0 * Q * (1.0 - 2.0 * Q)) * (b * b);
  C root = square_root(inside);
  if (size2(e + root) < size2(e - root)) root = -root;
  const C y = ((1.0 - 2.0 * Q) * b) / (e + root), one{1.0, 0.0};
  C s = square_root(y * y - one);
  if (size2(y + s) < size2(y - s)) s = -s;
  C x0 = y + s;
  for (int i = 0; i < 8; ++i)
    if (improve(Q, e, b, x0) < 1e-9) break;
  Complex<DD> x = widened(x0);
  for (int i = 0; i < 60; ++i)  // slowly where the start is nearly an extreme of O / E
    if (improve(nome, xE, a, x) < 1e-17) break;

  const Theta<DD> f(nome, x);
  const bool odd_leads = size2(f.O).hi > size2(f.E).hi;
  const Complex<DD> ratio = odd_leads ? a / f.O : xE / f.E;
  const Complex<DD> found = (f.dO * f.E - f.O * f.dE) * (ratio * ratio);
  if (size2(found - wronskian).hi > size2(found + wronskian).hi) x = Complex<DD>{DD(1.0), DD(0.0)} / x;
  return x;
}

}  // namespace polhode::POLHODE_ISA::gyrostat
