#pragma once

#include "polhode/math/detail/double_double.hpp"

namespace polhode::math {

/// How many Landen stages bring a modulus k <= 0.985 below the rounding of N.
template <class N>
inline constexpr int landen_stages = 5;
template <class T>
inline constexpr int landen_stages<DoubleDouble<T>> = 6;

/// The descending Landen (Gauss) chain of a modulus k and its complement k', both given, k^2 + k'^2 = 1:
///   k_{i+1} = k_i^2 / (1 + k'_i)^2,  k'_{i+1} = 2 sqrt(k'_i) / (1 + k'_i).
/// Everything positive, nothing subtracted: each k_i keeps its relative accuracy as k -> 0. For k^2 <= 0.97.
/// Gauss 1818; formulas as in the NIST Handbook (dlmf.nist.gov) 19.8 and 22.7.
template <class N>
struct LandenChain {
  static constexpr int stages = landen_stages<N>;
  N k[stages + 1];
  N kc[stages + 1];

  POLHODE_INLINE LandenChain() = default;
  POLHODE_INLINE LandenChain(N modulus, N complement) {
    k[0] = modulus;
    kc[0] = complement;
    for (int i = 1; i <= stages; ++i) advance(i);
  }

  /// Stage i from the one before.
  POLHODE_INLINE void advance(int i) {
    const N inverse = N(1.0) / one_plus(kc[i - 1]), ratio = k[i - 1] * inverse;
    k[i] = ratio * ratio;
    kc[i] = twice(sqrt(kc[i - 1]) * inverse);
  }

  /// 2 K(k) / pi, where K is the complete integral of the first kind.
  POLHODE_INLINE N two_K_over_pi() const {
    N product = one_plus(k[1]);
    for (int i = 2; i <= stages; ++i) product = product * one_plus(k[i]);
    return product;
  }

  /// The nome q = exp(-pi K'/K) with its relative accuracy for any k -> 0, without log or exp:
  /// the product of the chain up to k_4, whose own nome is a short series in k_4^2 / 16.
  POLHODE_INLINE N nome() const {
    const N s0 = one_plus(kc[0]), s1 = one_plus(kc[1]), s2 = one_plus(kc[2]), s3 = one_plus(kc[3]);
    const N x = k[4] * k[4] * N(0.0625);
    const N tail = one_plus(x * plus(N(0.5), x * N(3.375)));
    const N c = Constant<N>::of(0.8408964152537145, 4.099505010290748e-17);  // 2^(-1/4)
    return k[0] * k[0] * c * tail / (s0 * s0 * s1 * sqrt(s2 * sqrt(s3)));
  }
};

/// The end of an imaginary descent: with (P, Q, R) proportional to (sn, cn, dn)(y, k') and zeta = pi y / 2K,
/// e^-zeta = Q / (P + H), cosh(zeta) e^-zeta = H / (P + H), sinh(zeta) e^-zeta = P / (P + H).
template <class N>
struct ImaginaryDescent {
  N P, Q, H;
  POLHODE_INLINE N exp_minus() const { return Q / plus(P, H); }
};

/// sqrt(a^2 + b^2) for a, b >= 0 of any size, from the larger: either may be 1e-200 of the other. 0 for 0, 0.
template <class N>
POLHODE_INLINE N hypotenuse(N a, N b) {
  const auto first = a > b;
  const N large = select(first, a, b), small = select(first, b, a);
  const N ratio = small / select(large == N(0.0), N(1.0), large);
  return large * sqrt(one_plus(ratio * ratio));
}

/// Jacobi's imaginary argument down the chain of k: only positive terms. Needs P >= 0, Q + R > 0.
template <class N>
POLHODE_INLINE ImaginaryDescent<N> descend_imaginary(const LandenChain<N>& chain, N P, N Q, N R) {
  for (int i = 1; i <= chain.stages; ++i) {
    P = twice(P);
    Q = plus(Q, R) * one_plus(chain.k[i]);
    if (i == chain.stages) break;
    const N slope = chain.k[i] * P / Q;
    R = Q * sqrt(plus(N(1.0), slope * slope));
  }
  return {P, Q, hypotenuse(P, Q)};
}

/// The chain of a modulus, k^2 <= 0.97, and beside it an imaginary descent: stage by stage, so that the one is computed
/// while the other waits for a division. The last stages need little: k_4 and k_4 sinh(zeta) are below 2e-5, since
/// k_4 = 4 q^8, sinh(zeta) <= q^(-1/2) / 2 and q < 0.21.
template <class T>
struct ImaginaryChain {
  using N = DoubleDouble<T>;
  LandenChain<N> chain;
  N two_K_over_pi = N(1.0);
  ImaginaryDescent<N> end;

  POLHODE_INLINE ImaginaryChain(N k, N kc, N P, N Q, N R) {
    chain.k[0] = k, chain.kc[0] = kc;
    for (int i = 1; i <= 4; ++i) {
      chain.advance(i);
      const N growth = one_plus(chain.k[i]);
      two_K_over_pi = two_K_over_pi * growth;
      P = twice(P), Q = plus(Q, R) * growth;
      const N slope = chain.k[i] * P / Q, x = slope * slope;
      R = i < 4 ? Q * sqrt(plus(N(1.0), x))
                : Q + Q * (scaled(x, T(0.5)) - N(x.hi * x.hi * (T(0.125) - T(0.0625) * x.hi)));
    }
    const N k4 = chain.k[4] / one_plus(chain.kc[4]), k5 = k4 * k4, growth = one_plus(k5);
    const T k6 = T(0.25) * k5.hi * k5.hi;   // below 1e-21, as the square of the slope
    P = twice(P), Q = plus(Q, R) * growth;
    const T slope = k5.hi * P.hi / Q.hi;
    P = twice(P), Q = twice(Q) + N(Q.hi * madd(T(0.5) * slope, slope, k6 + k6));
    two_K_over_pi = two_K_over_pi * growth;
    two_K_over_pi = two_K_over_pi + N(two_K_over_pi.hi * k6);
    chain.k[5] = k5, chain.k[6] = N(k6), chain.kc[5] = chain.kc[6] = N(1.0);
    end = {P, Q, hypotenuse(P, Q)};
  }
};

/// (X, Y) proportional to (cos z, sin z), z = pi u / 2K, from (P, C, Q, R) proportional to (sn, cn, 1, dn)(u, k):
/// the descent of Landen's amplitude by angle doubling, right in every quadrant.
template <class N>
struct RealDescent {
  N X, Y;
};

template <class N>
POLHODE_INLINE RealDescent<N> descend_real(const LandenChain<N>& chain, N P, N C, N Q, N R) {
  N X = C, Y = P;
  for (int i = 1; i <= chain.stages; ++i) {
    P = twice(P);
    Q = plus(Q, R) * one_plus(chain.k[i]);
    const N kP = chain.k[i] * P;
    R = sqrt((Q - kP) * (Q + kP));
    Y = Y * R;
    X = X * Q * one_plus(chain.k[i]);
  }
  return {X, Y};
}

}  // namespace polhode::math
