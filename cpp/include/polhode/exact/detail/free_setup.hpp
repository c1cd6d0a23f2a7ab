#pragma once

#include "polhode/exact/detail/free_series.hpp"
#include "polhode/math/detail/atan2.hpp"
#include "polhode/math/detail/landen.hpp"

// The constants of the motion from moments and angular velocity, all in double-double: a rate known to 1e-32 keeps the
// phase over a billion cycles. Templates over the number type, with selects in place of branches.
namespace polhode::exact {

/// Moments and angular velocity in working axes, and the rotation v_B = M v' to the given axes.
/// The largest moment and the largest |w| are in [1, 2): the caller scales by powers of two.
template <class T>
struct FreeStart {
  T I[3], w[3], M[3][3];
};

/// Jacobi's constants of the motion.
template <class T>
struct FreeConstants {
  using N = DoubleDouble<T>;
  FreeStart<T> start;    ///< m3 >= 0, the third axis is the encircled one, I need not ascend
  N m[3], L, twice_T;    ///< angular momentum, its size, 2 T
  N r, r12;              ///< d2 / d1 and d12 / d1, d's the differences of inverse moments; r + r12 = 1
  N La1, La3, a1, a3;    ///< amplitudes: m1 = L a1 cn u, m2 = L a2 sn u, m3 = L a3 dn u, a2 = a1 / sqrt(r)
  N k, kc, p;            ///< modulus, complement, u = p t + u0
};

/// L^2 - 2 T I2 = I3 w3^2 (I3 - I2) - I1 w1^2 (I2 - I1), computed exactly and rounded to double-double. It is the only
/// quantity that cancels. The caller uses this where double-double would lose more than 20 bits (`lost`).
DoubleDouble<double> separatrix_distance_exact(double I1, double I2, double I3, double w1, double w3);

POLHODE_INLINE void make_exact(bool lost, DoubleDouble<double>& distance, double I1, double I2, double I3, double w1,
                               double w3) {
  if (lost) distance = separatrix_distance_exact(I1, I2, I3, w1, w3);
}

template <class M, class T>
POLHODE_INLINE void exchange(M mask, T& a, T& b) {
  const T old = a;
  a = select(mask, b, a);
  b = select(mask, old, b);
}

/// Rotates the axes a, b by a quarter turn where the mask is set: (v_a, v_b) -> (v_b, -v_a).
template <class M, class T>
POLHODE_INLINE void quarter_turn(M mask, FreeStart<T>& s, int a, int b) {
  exchange(mask, s.I[a], s.I[b]);
  exchange(mask, s.w[a], s.w[b]);
  s.w[b] = select(mask, -s.w[b], s.w[b]);
  for (int c = 0; c < 3; ++c) {
    exchange(mask, s.M[c][a], s.M[c][b]);
    s.M[c][b] = select(mask, -s.M[c][b], s.M[c][b]);
  }
}

template <class T>
POLHODE_INLINE FreeConstants<T> analyse(FreeStart<T> s) {
  using namespace math;
  using N = DoubleDouble<T>;
  const T zero(0.0), one(1.0);
  quarter_turn(s.I[0] > s.I[1], s, 0, 1);
  quarter_turn(s.I[1] > s.I[2], s, 1, 2);
  quarter_turn(s.I[0] > s.I[1], s, 0, 1);

  // w1 and w3 have a scale of their own, so that 1e-160 beside 1 does not underflow.
  const T size13 = max(abs(s.w[0]), abs(s.w[2]));
  const T unit13 = select(size13 == zero, one, power_of_two_below(size13));
  const T w1 = s.w[0] / unit13, w3 = s.w[2] / unit13;
  const N high = two_diff(s.I[2], s.I[1]), low = two_diff(s.I[1], s.I[0]);
  const N term3 = two_prod(w3, w3) * s.I[2] * high, term1 = two_prod(w1, w1) * s.I[0] * low;
  N distance = term3 - term1;
  make_exact(abs(distance.hi) < T(0x1p-20) * (term3.hi + term1.hi), distance, s.I[0], s.I[1], s.I[2], w1, w3);

  const auto swap = (distance.hi < zero) | ((distance.hi == zero) & (s.I[1] == s.I[2]));
  quarter_turn(Mask<T>(swap), s, 0, 2);  // (w3, w2, -w1), then rotated by pi about axis 1 if that makes m3 >= 0:
  const auto down = s.w[2] < zero;
  for (int a = 0; a < 2; ++a) {
    // a rotation by pi about axis 1 changes the signs of axes 2 and 3
    s.w[a + 1] = select(down, -s.w[a + 1], s.w[a + 1]);
    for (int c = 0; c < 3; ++c) s.M[c][a + 1] = select(down, -s.M[c][a + 1], s.M[c][a + 1]);
  }

  FreeConstants<T> f;
  N n[3];
  f.twice_T = N(0.0);
  for (int a = 0; a < 3; ++a) {
    f.m[a] = two_prod(s.I[a], s.w[a]);
    n[a] = f.m[a] * f.m[a];
    f.twice_T = plus(f.twice_T, f.m[a] * s.w[a]);
  }
  f.L = sqrt(plus(plus(n[0], n[1]), n[2]));

  const N J1(s.I[0]), J2(s.I[1]), J3(s.I[2]);
  const N d1 = abs(two_diff(s.I[2], s.I[0])) / (J1 * J3), d2 = abs(two_diff(s.I[2], s.I[1])) / (J2 * J3);
  const N d12 = abs(two_diff(s.I[1], s.I[0])) / (J1 * J2);
  const auto sphere = d1.hi == zero, symmetric = d12.hi == zero;
  const N d1s = select(sphere, N(1.0), d1);
  f.r = select(sphere, N(1.0), d2 / d1s);
  f.r12 = d12 / d1s;
  f.La1 = hypotenuse(abs(f.m[0]), abs(f.m[1]) * sqrt(f.r));
  f.La3 = hypotenuse(abs(f.m[2]), abs(f.m[1]) * sqrt(f.r12));
  f.a1 = f.La1 / f.L;
  f.a3 = f.La3 / f.L;

  const N La3s = select(f.La3.hi == zero, N(1.0), f.La3), d2s = select(d2.hi == zero, N(1.0), d2);
  N k = select(symmetric, N(0.0), f.La1 / La3s * sqrt(d12 / d2s));
  N kc = select(symmetric, N(1.0), scaled(sqrt(abs(distance) / (J2 * d2s)) / La3s, unit13));
  const auto k_small = k < kc;
  f.k = select(k_small, k, sqrt((N(1.0) - kc) * (N(1.0) + kc)));
  f.kc = select(k_small, sqrt((N(1.0) - k) * (N(1.0) + k)), kc);
  const N p = f.La3 * sqrt(d1 * d2);
  f.p = select(Mask<T>(swap), -p, p);
  f.start = s;
  return f;
}

/// Degrees 0 to 4 of the Chebyshev-like families in X = cos 2 phi: cos 2m phi = T_m, sin 2m phi = sin 2 phi
/// U_{m-1}, cos (2m + 1) phi = cos phi V_m, sin (2m + 1) phi = sin phi W_m.
inline constexpr double chebyshev_T[5][5] = {{1}, {0, 1}, {-1, 0, 2}, {0, -3, 0, 4}, {1, 0, -8, 0, 8}};
inline constexpr double chebyshev_U[3][3] = {{1}, {0, 2}, {-1, 0, 4}};
inline constexpr double chebyshev_V[5][5] = {
    {1}, {-1, 2}, {-1, -2, 4}, {1, -4, -4, 8}, {1, 4, -12, -8, 16}};
inline constexpr double chebyshev_W[5][5] = {
    {1}, {1, 2}, {-1, 2, 4}, {-1, -4, 4, 8}, {1, -4, -12, 8, 16}};

/// monomials[i] = sum over m of weight[m] * family[m][i].
template <class T, int n, int width>
POLHODE_INLINE void expand(const double (&family)[width][width], const T (&weight)[n], T (&monomials)[n]) {
  for (int i = 0; i < n; ++i) {
    T sum(0.0);
    for (int m = n - 1; m >= i; --m) sum = madd(T(family[m][i]), weight[m], sum);
    monomials[i] = select(abs(sum) < T(1e-290), T(0.0), sum);   // operations with subnormal numbers are slow
  }
}

template <class T>
POLHODE_INLINE FreeTrig<T> set_up_trig(const FreeConstants<T>& f) {
  using namespace math;
  using N = DoubleDouble<T>;
  const T zero(0.0), one(1.0);
  const auto steady = f.a1.hi == zero;
  const N a1 = select(steady, N(1.0), f.a1);  // any number: rho is set to 0 below
  const ImaginaryChain<T> descent(f.k, f.kc, f.a3, a1, a1 / sqrt(f.r));
  const LandenChain<N>& chain = descent.chain;
  const N ratio_K = descent.two_K_over_pi;
  const N q = select(steady, N(0.0), chain.nome());
  const N rho = select(steady, N(0.0), descent.end.exp_minus());
  const N q_rho = select(rho.hi == zero, N(0.0), q / select(rho.hi == zero, N(1.0), rho));

  // The start's theta argument: a constant, double is enough.
  LandenChain<T> chain1;
  for (int i = 0; i <= chain1.stages; ++i) chain1.k[i] = chain.k[i].hi, chain1.kc[i] = chain.kc[i].hi;
  const N La1 = select(steady, N(1.0), f.La1);
  const T sn = select(steady, zero, (f.m[1] * sqrt(f.r) / La1).hi), cn = select(steady, one, (f.m[0] / La1).hi);
  const N La3 = select(f.La3.hi == zero, N(1.0), f.La3);
  const T dn = select(f.La3.hi == zero, one, (f.m[2] / La3).hi);
  const auto z0 = descend_real(chain1, sn, cn, one, dn);

  // G_j = q^{j(j-1)/2} rho^j, j = 1 ... 10, and the same of q / rho, each from the one before by q^{j-1} rho. The mean
  // rate needs the first four in double-double: the sixth is below q^15 = 7e-11, which leaves 1e-26 of the rate.
  constexpr int most = 10, close = 4;
  N near_up[close + 1], near_down[close + 1], step_up = rho, step_down = q_rho;
  near_up[1] = rho, near_down[1] = q_rho;
  for (int j = 2; j <= close; ++j) {
    step_up = step_up * q, step_down = step_down * q;
    near_up[j] = near_up[j - 1] * step_up, near_down[j] = near_down[j - 1] * step_down;
  }
  T up[most + 1], down[most + 1], far_up = step_up.hi, far_down = step_down.hi;
  for (int j = 1; j <= close; ++j) up[j] = near_up[j].hi, down[j] = near_down[j].hi;
  for (int j = close + 1; j <= most; ++j) {
    far_up = far_up * q.hi, far_down = far_down * q.hi;
    up[j] = up[j - 1] * far_up, down[j] = down[j - 1] * far_down;
  }
  T far_sum(0.0), far_moment(0.0);
  for (int j = most; j > close; j -= 2) {
    far_sum = far_sum + (up[j] + down[j]);
    far_moment = madd(T(double(j)), up[j] - down[j], far_moment);
  }
  N sum(far_sum), moment(far_moment);
  for (int j = close; j >= 2; j -= 2) {
    sum = plus(sum, plus(near_up[j], near_down[j]));
    moment = plus(moment, (near_up[j] - near_down[j]) * T(double(j)));
  }
  sum = plus(N(1.0), sum);

  const N J3(f.start.I[2]);
  const N a3kc = f.a3 * f.kc;
  const N inverse_turn = Constant<N>::of(0.15915494309189535, -9.839338337591243e-18);  // 1 / 2 pi
  const N nu = f.p / ratio_K;
  const N psi1 = plus(f.twice_T / f.L, f.La3 * f.kc / J3) / one_plus(a3kc);
  const N kappa = scaled(psi1, T(0.5)) - nu * (moment / sum);

  FreeTrig<T> c;
  const N nu_cycles = nu * inverse_turn, kappa_cycles = kappa * inverse_turn;
  c.nu_hi = nu_cycles.hi, c.nu_lo = nu_cycles.lo;
  c.kappa_hi = kappa_cycles.hi, c.kappa_lo = kappa_cycles.lo;
  c.phi0 = atan2_cycles(z0.Y, z0.X) - T(0.25);

  T ec[4], es[3], oc[4], os[4];
  ec[0] = one;
  T odd_sum = up[1] + down[1], even_sum = one;
  for (int m = 1; m < 4; ++m) {
    ec[m] = up[2 * m] + down[2 * m];
    es[m - 1] = up[2 * m] - down[2 * m];
    even_sum = even_sum + ec[m];
  }
  for (int m = 0; m < 4; ++m) {
    oc[m] = up[2 * m + 1] + down[2 * m + 1];
    os[m] = up[2 * m + 1] - down[2 * m + 1];
    if (m > 0) odd_sum = odd_sum + oc[m];
  }
  expand(chebyshev_T, ec, c.even_cos);
  expand(chebyshev_U, es, c.even_sin);
  expand(chebyshev_V, oc, c.odd_cos);
  expand(chebyshev_W, os, c.odd_sin);

  // m_i are theta_1, theta_2, theta_4 over |alpha|^2 + |beta|^2. Its value at phi = 0 gives the factors.
  const T n0 = madd(even_sum, even_sum, odd_sum * odd_sum);
  const T t = q.hi, t2 = t * t, t4 = t2 * t2, t6 = t4 * t2, t9 = t4 * t4 * t, t12 = t6 * t6, t16 = t12 * t4,
          t20 = t16 * t4;
  const T theta4 = one - T(2.0) * t + T(2.0) * t4 - T(2.0) * t9 + T(2.0) * t16;
  const T theta2 = one + t2 + t6 + t12 + t20;
  const T theta1 = one - T(3.0) * t2 + T(5.0) * t6 - T(7.0) * t12 + T(9.0) * t20;
  const N La2 = select(steady, N(0.0), f.La1) / sqrt(f.r);
  const T c3 = (f.La3 * f.kc / J3).hi * n0 / theta4;
  const T c2 = (La2 / f.start.I[1]).hi * n0 / theta2;
  const T c1 = -((select(steady, N(0.0), f.La1) * f.kc * ratio_K / f.start.I[0]).hi * n0) / theta1;
  const T w3[5] = {c3, -(T(2.0) * t) * c3, T(2.0) * t4 * c3, -(T(2.0) * t9) * c3, T(2.0) * t16 * c3};
  const T w2[5] = {c2, t2 * c2, t6 * c2, t12 * c2, t20 * c2};
  const T w1[5] = {c1, -(t2 * c1), t6 * c1, -(t12 * c1), t20 * c1};
  expand(chebyshev_W, w1, c.omega[0]);
  expand(chebyshev_V, w2, c.omega[1]);
  expand(chebyshev_T, w3, c.omega[2]);
  return c;
}

}  // namespace polhode::exact
